#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A driven, damped, absorbing model, whose concrete may crack, loses no
     *  energy to nowhere. */
    class EnergyAccounted : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto     parameters = make_case(file);
        const auto     simulation = make_simulation(*parameters, communicator);
        const Schedule schedule(parameters->output.energy_interval,
                                simulation->run.time_step.length);
        while (simulation->run.state.time < parameters->time.end_time)
          {
            simulation->run.scheme.step(simulation->run.state);
            if (schedule.due(simulation->run.state.step))
              simulation->run.energy.evaluate(simulation->run.state);
          }
        const auto   summary = simulation->run.energy.summary();
        const double input   = summary["input [J]"];
        verdicts.above("lost in damping over input [%]",
                       100. * double(summary["lost in damping [J]"]) / input,
                       0.1);
        const bool cracks = simulation->model.internal_force.has_memory();
        if (cracks)
          verdicts.above(
            "lost to cracks over input [%]",
            100. * double(summary["lost to cracks and plastic flow [J]"]) /
              input,
            1.);
        verdicts.below("largest unaccounted share of the input",
                       summary["largest unaccounted share"],
                       cracks ? 0.01 : 0.005);
      }
    };

    const Registry<Check>::Add<EnergyAccounted>
      registered("energy accounted", "Energy balance of a driven model.");
  } // namespace
} // namespace Voussoir
