
#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** After the static stage nothing moves without an earthquake. */
    class Rest : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string supports : {"fixed", "roller", "springs"})
          {
            const auto parameters =
              make_case(file.with({"Static state/Supports=" + supports}));
            const auto simulation = make_simulation(*parameters, communicator);
            const Vector before   = simulation->run.state.displacement;
            double       fastest  = 0.;
            while (simulation->run.state.time < parameters->time.end_time)
              {
                simulation->run.scheme.step(simulation->run.state);
                if (simulation->run.state.step % 10 == 0)
                  keep_largest(fastest,
                               largest_entry(simulation->run.state.velocity));
              }
            Vector drift = simulation->run.state.displacement;
            drift -= before;
            const auto &stages = simulation->static_state.summary.at("stages");
            verdicts.above(
              "supports " + supports + ": largest static displacement [mm]",
              1e3 * stages.back().at("largest displacement [m]").get<double>(),
              1.);
            verdicts.below("largest velocity [m/s]", fastest, 1e-6);
            verdicts.below("drift [m]", largest_entry(drift), 1e-6);
          }
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<Rest>
      registered("rest", "A run without an earthquake after a static stage.");
  } // namespace
} // namespace Voussoir
