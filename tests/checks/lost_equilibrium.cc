#include <voussoir/base/error.h>
#include <voussoir/base/text.h>

#include <filesystem>

#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A stage without equilibrium is given up with a sentence that names the
     * moving parts; the state before the stage is written.
     */
    class LostStage : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Named",
          named,
          "Parts that the sentence must contain, separated by commas.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto  parameters = make_case(file.with({"Output/Folder=lost"}));
        std::string sentence;
        try
          {
            make_simulation_with_files(*parameters, communicator);
          }
        catch (const UserError &error)
          {
            sentence = error.what();
          }
        verdicts.is_true("given up", !sentence.empty());
        for (const std::string &name : split_list(named))
          verdicts.is_true("the sentence names " + name,
                           sentence.find(name) != std::string::npos);
        verdicts.is_true("the picture is there",
                         std::filesystem::exists("lost/last_good.vtu"));
        verdicts.is_true("so is the verdict",
                         read_summary("lost")
                             .value("verdict", "")
                             .rfind("stopped: The static stage", 0) == 0);
      }

    private:
      std::string named;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<LostStage>
      registered("lost equilibrium", "A static stage without equilibrium.");
  } // namespace
} // namespace Voussoir
