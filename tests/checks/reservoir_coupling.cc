#include <voussoir/fem/stable_step.h>
#include <voussoir/time/central_difference.h>

#include "tank.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * An elastic dam and its water exchange energy and lose none, up to the
     * stable step of the two together.
     */
    class ReservoirCoupling : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto       parameters = make_case(file);
        Tank             tank(*parameters, communicator);
        const auto       materials = parameters->material_list();
        const LumpedMass mass(tank.discretization,
                              {materials[0]->density},
                              {0.});
        InternalForce internal_force(tank.discretization, {materials[0]}, {1.});

        StepLimits   limits;
        const double solid =
          stable_step(tank.discretization, internal_force, mass, limits);
        limits.add_diagonal =
          [&](Vector &force, const Vector &displacement, const double dt) {
            tank.reservoir.add_coupling(force, displacement, dt);
          };
        const double together = std::min(
          0.95 * tank.reservoir.stable_step(),
          stable_step(tank.discretization, internal_force, mass, limits));
        verdicts.above("stable step with water over that of the solid",
                       together / solid,
                       0.8);

        const Damping      damping(parameters->damping);
        const InitialState initial_state;
        const double      time_step = parameters->time.safety_factor * together;
        WaterMotion       water(tank.reservoir, tank.base, time_step);
        CentralDifference scheme({tank.discretization,
                                  internal_force,
                                  mass,
                                  tank.terms,
                                  damping,
                                  initial_state,
                                  {&water}},
                                 LeapFrog{time_step});

        State state = scheme.initial_state();
        for (unsigned int node = 0; node < tank.discretization.n_owned_nodes();
             ++node)
          for (unsigned int d = 0; d < 3; ++d)
            if (mass.mass.local_element(3 * node + d) > 0.)
              state.velocity.local_element(3 * node + d) =
                std::sin(0.3 * tank.discretization.node_positions[node][2] + d);

        double initial = 0., worst = 0., in_water = 0.;
        for (unsigned int step = 0; step < 3000; ++step)
          {
            if (step % 100 == 0)
              {
                Vector before(state.displacement), momentum(state.velocity);
                before.add(-scheme.time_step, state.velocity);
                momentum.scale(mass.mass);
                const double stored =
                  water.stored_energy() +
                  Utilities::MPI::sum(water.loss, communicator);
                const double total =
                  0.5 * (momentum * state.velocity) +
                  0.5 * internal_force.elastic_work(state.displacement,
                                                    before,
                                                    {},
                                                    false) +
                  stored + water.work_ahead(state.velocity);
                if (step == 0)
                  initial = total;
                keep_largest(worst, std::abs(total - initial));
                keep_largest(in_water, stored);
              }
            scheme.step(state);
          }
        verdicts.above("largest part of the energy in the water",
                       in_water / initial,
                       0.05);
        verdicts.below("relative error of the sum", worst / initial, 1e-10);
      }
    };


    // Reference: closed form
    const Registry<Check>::Add<ReservoirCoupling>
      registered("reservoir coupling", "Energy of an elastic dam and water.");
  } // namespace
} // namespace Voussoir
