#include "tank.h"

#include <voussoir/base/parameter_file.h>

namespace Voussoir
{
  using namespace dealii;

  Tank::Tank(Case &parameters, const MPI_Comm communicator)
    : mesh(parameters.generator->generate())
    , water_mesh(split_off_reservoir(mesh,
                                     split_list(parameters.reservoir.cell_sets),
                                     "The tank"))
    , grid(
        mesh,
        parameters.grid,
        [](const unsigned int) { return 1.; },
        communicator)
    , discretization(grid,
                     parameters.discretization,
                     parameters.boundaries.supports.list(),
                     [](const Grid::Cell &) { return 0U; })
    , log(communicator, true)
    , reservoir(water_mesh,
                parameters.grid,
                parameters.reservoir,
                discretization,
                terms,
                log)
    , time_step(parameters.time.time_step > 0. ?
                  parameters.time.time_step :
                  parameters.time.safety_factor * reservoir.stable_step())
    , water(reservoir, base, time_step)
  {}


  void
  Tank::step(const Tensor<1, 3> &velocity, const Tensor<1, 3> &base_velocity)
  {
    Vector motion = discretization.create_vector();
    for (unsigned int i = 0; i < motion.locally_owned_size(); ++i)
      motion.local_element(i) = velocity[i % 3];
    forces.assign(terms.nodes.size(), Tensor<1, 3>());
    water.add_forces(time, forces);
    water.advance(motion, base_velocity);
    time += time_step;
  }


  Tensor<1, 3>
  Tank::thrust() const
  {
    Tensor<1, 3> sum;
    for (const Tensor<1, 3> &force : forces)
      sum += force;
    return Utilities::MPI::sum(sum, grid.communicator());
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
