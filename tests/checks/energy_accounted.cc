#include "check.h"
#include "march_with_energy.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Energy balance of a driven, damped, absorbing model, whose concrete may
     *  crack. */
    class EnergyAccounted : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Limit", limit, "Limit of the energy-balance error.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        const bool cracks =
          simulation->run.equation.internal_force.has_memory();
        double in_dampers = 0.; // loss of the dampers, step by step
        march_with_energy(simulation->run, [&](const bool) {
          if (!cracks)
            in_dampers +=
              simulation->run.time_step.length * loss_rate(*simulation);
        });
        const auto   summary = simulation->run.energy.summary();
        const double input   = summary.terms.input;
        verdicts.above("lost in damping over input [%]",
                       100. * summary.terms.damping / input,
                       0.1);
        if (!cracks)
          verdicts.near("lost in damping, and in the dampers one by one",
                        summary.terms.damping,
                        in_dampers,
                        0.01,
                        "J");
        if (cracks)
          verdicts.above("lost to cracks over input [%]",
                         100. * summary.terms.material / input,
                         1.);
        verdicts.below("largest energy-balance error over the input",
                       summary.largest_error,
                       limit);
        if (cracks)
          return;
        const auto rarely = make_case(file.with({"Output/Energy interval=0"}));
        const auto again  = make_simulation(*rarely, communicator);
        march_with_energy(again->run, [](const bool) {});
        verdicts.below("  evaluated every 50 steps",
                       again->run.energy.summary().largest_error,
                       0.01);
      }

    private:
      double limit = 1e-6;

      /** Power lost in the dampers of the cells and of the mass [W]. */
      static double
      loss_rate(const Simulation &simulation)
      {
        const Run     &run     = simulation.run;
        const Damping &damping = run.damping;
        const auto     work    = [&](const Vector &u) {
          return simulation.run.equation.internal_force.elastic_work(
            u, u, run.state.material_memory, true);
        };
        double rate =
          damping.stiffness_coefficient > 0. ?
            damping.stiffness_coefficient * work(run.state.velocity) :
            0.;
        // branch i is a spring D_i s K with a dashpot: w^T K w s / (D_i tau_i)
        for (unsigned int i = 0; i < run.state.memory.size(); ++i)
          rate += work(run.state.memory[i]) /
                  (damping.coefficients[i] * damping.relaxation_times[i]);
        Vector momentum = run.state.velocity;
        momentum.scale(simulation.model.solid.mass.mass);
        return rate +
               damping.mass_coefficient * (momentum * run.state.velocity);
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<EnergyAccounted>
      registered("energy accounted", "Energy balance of a driven model.");
  } // namespace
} // namespace Voussoir
