#include <voussoir/fem/nodal_values.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A short column that is pulled and pressed with growing amplitude fails
     * at its strength, at any frequency and damping. */
    class CrackStrength : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Strength", strength, "In tension [Pa].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const double ratio : {0.02, 0.05, 0.1, 0.15})
          for (const double frequency : {0.2, 3., 20.})
            {
              const std::string f = std::to_string(frequency);
              // the elastic limit is passed within the fifth period
              const auto parameters = make_case(
                file.with({"Damping/Ratio=" + std::to_string(ratio),
                           "Constraints/pull/Time function=" + f +
                             "/4.5*t*sin(2*pi*" + f + "*t)",
                           "Time/End time=" + std::to_string(5. / frequency)}));
              std::ostringstream name;
              name << "strength with " << 100. * ratio << " % at " << frequency
                   << " Hz";
              verdicts.near(name.str(),
                            1e-6 * largest_stress(*parameters, communicator),
                            1e-6 * strength,
                            0.02,
                            "MPa");
            }
      }

    private:
      double
      largest_stress(const Case &parameters, const MPI_Comm communicator) const
      {
        const auto simulation = make_simulation(parameters, communicator);
        Run       &run        = simulation->run;
        const InternalForce &internal_force =
          simulation->run.equation.internal_force;
        const MaxwellStep maxwell(run.damping, run.time_step.length);
        Vector force = simulation->model.solid.discretization.create_vector();
        Vector filtered = force;
        double largest  = 0.;
        while (run.state.time < parameters.time.end_time)
          {
            // the force at the beginning of this step
            filtered = run.state.displacement;
            filtered.add(run.damping.mesh_viscosity, run.state.velocity);
            for (unsigned int i = 0; i < run.state.memory.size(); ++i)
              filtered.add(maxwell.decay[i],
                           run.state.memory[i],
                           maxwell.gain[i],
                           run.state.velocity);
            MaterialMemory memory = run.state.material_memory;
            internal_force.sweep(
              force,
              {run.state.displacement,
               filtered,
               SweepInput::Damping::common,
               nullptr,
               {run.time_step.length}},
              memory,
              [&](const unsigned int begin, const unsigned int end) {
                std::fill(force.begin() + begin, force.begin() + end, 0.);
              },
              {});
            double pull = 0.;
            for (unsigned int node = 0;
                 node < simulation->model.solid.discretization.n_owned_nodes();
                 ++node)
              if (simulation->model.solid.discretization
                    .node_positions[node][2] == 0.)
                pull -= node_value(force, node)[2];
            keep_largest(largest, pull); // on one square metre
            run.scheme.step(run.state);
          }
        return largest;
      }

      double strength = 2e6;
    };

    // Reference: closed form
    const Registry<Check>::Add<CrackStrength>
      registered("crack strength", "One strength at all rates and dampings.");
  } // namespace
} // namespace Voussoir
