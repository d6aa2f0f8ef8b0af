#include <voussoir/analysis/modal_water.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Tolerance of the pressure: the mass must be symmetric to well below the
    // tolerance of the modes.
    constexpr double tolerance = 1e-10;


    std::vector<unsigned int>
    surface_of(const Reservoir &reservoir)
    {
      std::vector<unsigned int> result;
      for (unsigned int i = 0; i < reservoir.space.node_positions.size(); ++i)
        if (reservoir.inverse_storage.local_element(i) == 0.)
          result.push_back(i);
      return result;
    }
  } // namespace


  ModalWater::ModalWater(const Reservoir &reservoir, const double stiffness)
    : stiffness(stiffness)
    , reservoir(reservoir)
    , surface(surface_of(reservoir))
    , solver(reservoir.space, surface)
    , flux(reservoir.space.create_vector())
    , pressure(flux)
    , at_wall(reservoir.create_wall_vector())
  {
    if (stiffness == 0.)
      return;
    for (unsigned int i = 0; i < flux.locally_owned_size(); ++i)
      weight.push_back(std::sqrt(stiffness * reservoir.compressibility *
                                 reservoir.space.volumes.local_element(i)));
    clear_surface(weight.data());
  }


  unsigned int
  ModalWater::size() const
  {
    return weight.size();
  }


  void
  ModalWater::clear_surface(double *water_motion) const
  {
    for (const unsigned int i : surface)
      water_motion[i] = 0.;
  }


  void
  ModalWater::add_momentum(Vector       &momentum,
                           double       *water_momentum,
                           const Vector &motion,
                           const double *water_motion) const
  {
    at_wall = 0.;
    reservoir.gather_flux(at_wall, motion);
    flux.copy_locally_owned_data_from(at_wall);
    for (unsigned int i = 0; i < weight.size(); ++i)
      flux.local_element(i) += weight[i] * water_motion[i];
    add_momentum_of_flux(momentum, water_momentum);
  }


  void
  ModalWater::add_momentum_of_floor(Vector            &momentum,
                                    double            *water_momentum,
                                    const unsigned int direction) const
  {
    flux = 0.;
    for (const Reservoir::WallNode &node : reservoir.floor_nodes)
      flux.local_element(node.water) += node.area[direction];
    add_momentum_of_flux(momentum, water_momentum);
  }


  void
  ModalWater::add_momentum_of_flux(Vector &momentum,
                                   double *water_momentum) const
  {
    clear_surface(flux.begin());
    solver.solve(pressure, flux, tolerance);
    pressure *= reservoir.density;
    for (unsigned int i = 0; i < weight.size(); ++i)
      water_momentum[i] += weight[i] * pressure.local_element(i);
    at_wall.copy_locally_owned_data_from(pressure);
    at_wall.update_ghost_values();
    for (const Reservoir::Pair &pair : reservoir.pairs)
      for (unsigned int d = 0; d < 3; ++d)
        momentum.local_element(3 * pair.node + d) +=
          pair.area[d] * at_wall.local_element(pair.water);
    at_wall.zero_out_ghost_values();
  }
} // namespace Voussoir
