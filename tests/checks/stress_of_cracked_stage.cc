#include <voussoir/base/text.h>

#include "with_files.h"

namespace Voussoir
{
  namespace
  {
    /**
     * The stress of the static state is the same after its last stage and at
     * the start of the run: moduli and strengths of the run do not change it,
     * neither where concrete has cracked nor where its stress beside the
     * integration points is limited by the strength at rest.
     */
    class StressOfCrackedStage : public Check
    {
    public:
      void
      declare_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter("Settings",
                          settings,
                          "Entries that are changed, as in \"entry = value & "
                          "entry = value | ...\".");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string &setting : split_list(settings, '|'))
          {
            const auto parameters =
              make_case(file.with(split_list(setting, '&')));
            make_simulation_with_files(*parameters, communicator)->run.march();
            const nlohmann::json summary =
              read_summary(parameters->output.folder);
            const nlohmann::json &stage = summary.at("static state")
                                            .at("stages")
                                            .back()
                                            .at("faces")
                                            .at("back"),
                                 &start = summary.at("face stresses");
            for (const std::string quantity :
                 {"largest cantilever stress [MPa]",
                  "largest principal stress [MPa]",
                  "smallest principal stress [MPa]"})
              verdicts.near(setting + ": " + quantity,
                            start.at(quantity),
                            stage.at(quantity),
                            1e-5);
          }
      }

    private:
      std::string settings;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<StressOfCrackedStage>
      registered("stress of a cracked stage",
                 "The stress of the static state after its stages and at the "
                 "start of the run.");
  } // namespace
} // namespace Voussoir
