#include <map>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A wave that enters a box from below: the surface moves twice as much as
     * the incident wave, all nodes of a level move alike, and the box is at
     * rest when the wave has left.
     */
    class VerticalWave : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Residual",
                          residual,
                          "Largest velocity that may remain at the end over "
                          "the incident one.");
        prm.add_parameter("Uniformity",
                          uniformity,
                          "Largest difference between nodes of a level over "
                          "the incident displacement.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        const auto motion =
          parameters->ground_motion.build(parameters->file.folder());

        const Discretization &discretization =
          simulation->model.solid.discretization;
        double top = -1e300;
        for (const Point<3> &p : discretization.node_positions)
          keep_largest(top, p[2]);
        top = Utilities::MPI::max(top, communicator);

        Tensor<1, 3> incident, incident_velocity, surface;
        double       spread = 0.;
        while (simulation->run.state.time < parameters->time.end_time)
          {
            simulation->run.scheme.step(simulation->run.state);
            // extremes of each level over the ranks, at intervals
            const bool evaluated = simulation->run.state.step % 10 == 0;
            std::map<long, std::array<double, 6>> levels;
            for (unsigned int node = 0; node < discretization.n_owned_nodes();
                 ++node)
              {
                const double z = discretization.node_positions[node][2];
                if (discretization.hanging_nodes.is_constrained(
                      discretization.owned_dofs.nth_index_in_set(3 * node)))
                  continue;
                auto &extremes =
                  levels
                    .emplace(std::lround(1e3 * z),
                             std::array<double, 6>{
                               {1e300, 1e300, 1e300, -1e300, -1e300, -1e300}})
                    .first->second;
                for (unsigned int d = 0; d < 3; ++d)
                  {
                    const double u =
                      simulation->run.state.displacement.local_element(
                        3 * node + d);
                    extremes[d] = std::min(extremes[d], u);
                    keep_largest(extremes[3 + d], u);
                    if (z > top - 1e-6)
                      keep_largest(surface[d], std::abs(u));
                  }
              }
            if (evaluated)
              {
                std::map<long, std::array<double, 6>> merged;
                for (const auto &part :
                     Utilities::MPI::all_gather(communicator, levels))
                  for (const auto &[level, extremes] : part)
                    {
                      auto &sum = merged.emplace(level, extremes).first->second;
                      for (unsigned int d = 0; d < 3; ++d)
                        {
                          sum[d] = std::min(sum[d], extremes[d]);
                          keep_largest(sum[3 + d], extremes[3 + d]);
                        }
                    }
                for (const auto &level : merged)
                  for (unsigned int d = 0; d < 3; ++d)
                    keep_largest(spread, level.second[3 + d] - level.second[d]);
              }
            for (unsigned int d = 0; d < 3; ++d)
              if (motion[d])
                {
                  const double t = simulation->run.state.time;
                  keep_largest(incident[d],
                               std::abs(motion[d]->displacement(t)));
                  keep_largest(incident_velocity[d],
                               std::abs(motion[d]->velocity(t)));
                }
          }

        for (unsigned int d = 0; d < 3; ++d)
          if (incident[d] > 0.)
            verdicts.near(std::string("surface over incident ") + "xyz"[d],
                          Utilities::MPI::max(surface[d], communicator) /
                            incident[d],
                          2.,
                          0.01);
        verdicts.below("spread within a level over incident",
                       spread / incident.norm(),
                       uniformity);
        verdicts.below("velocity left over incident",
                       largest_entry(simulation->run.state.velocity) /
                         incident_velocity.norm(),
                       residual);
        simulation->run.energy.evaluate(simulation->run.state);
        verdicts.below("energy-balance error",
                       simulation->run.energy.relative_error(),
                       0.005);
      }

    private:
      double residual = 0.01, uniformity = 1e-10;
    };

    // Reference: closed form
    const Registry<Check>::Add<VerticalWave>
      registered("vertical wave", "Surface motion, uniformity, rest after.");
  } // namespace
} // namespace Voussoir
