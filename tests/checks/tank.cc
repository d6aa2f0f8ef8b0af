#include "tank.h"

#include <voussoir/base/parameter_file.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    NodalTerms
    terms_of(const Reservoir &reservoir, const Discretization &discretization)
    {
      NodalTerms terms(discretization.n_owned_nodes());
      terms.add_nodes(reservoir.wet_nodes());
      return terms;
    }
  } // namespace


  Tank::Tank(const Case &parameters, const MPI_Comm communicator)
    : mesh(parameters.generator->generate())
    , water_mesh(split_off_reservoir(mesh,
                                     split_list(parameters.reservoir.cell_sets),
                                     "The tank"))
    , grid(mesh, parameters.grid, communicator)
    , discretization(grid,
                     parameters.discretization,
                     parameters.boundaries.supports.list())
    , log(communicator, true)
    , reservoir(water_mesh,
                parameters.grid,
                parameters.reservoir,
                discretization,
                log)
    , time_step(parameters.time.time_step > 0. ?
                  parameters.time.time_step :
                  parameters.time.safety_factor * reservoir.stable_step())
    , water(reservoir, base, time_step)
    , terms(terms_of(reservoir, discretization))
    , forces(terms)
  {}


  void
  Tank::step(const Tensor<1, 3> &velocity, const Tensor<1, 3> &base_velocity)
  {
    Vector motion = discretization.create_vector();
    for (unsigned int i = 0; i < motion.locally_owned_size(); ++i)
      motion.local_element(i) = velocity[i % 3];
    forces.reset();
    water.add_forces(time, forces);
    water.advance(motion, base_velocity);
    time += time_step;
  }


  Tensor<1, 3>
  Tank::thrust() const
  {
    return Utilities::MPI::sum(forces.sum(), grid.communicator());
  }


  double
  Tank::pressure(const Point<3> &position) const
  {
    double value = 0.;
    for (unsigned int i = 0; i < reservoir.space.node_positions.size(); ++i)
      if (position.distance(reservoir.space.node_positions[i]) < 1e-6)
        value += water.pressure.local_element(i);
    return Utilities::MPI::sum(value, grid.communicator());
  }


  double
  pulse(const double time, const double duration)
  {
    const double x = time / duration;
    return x > 0. && x < 1. ?
             Utilities::fixed_power<4>(std::sin(numbers::PI * x)) :
             0.;
  }
} // namespace Voussoir
