#include <voussoir/base/error.h>

#include <filesystem>
#include <fstream>

#include "folders.h"
#include "same.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    /** Runs share no folder, and overwriting removes results of the run only.
     */
    class ResultFolders : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters =
          make_case(file.with({"Output/Folder=results/"}));
        Log        log(communicator, true);
        RunOptions plain, overwrite;
        overwrite.overwrite = true;
        const auto refusal  = [&](const RunOptions &options) {
          try
            {
              ResultFolder(*parameters, options, log).claim(log);
            }
          catch (const UserError &error)
            {
              return std::string("refused: ") + error.what();
            }
          return std::string("claimed");
        };

        remove_folders({"results", "results-2"}, communicator);
        {
          // both runs check the folder before one of them claims it
          ResultFolder one(*parameters, plain, log),
            other(*parameters, plain, log);
          verdicts.is_true("nothing is there before", !fs::exists("results"));
          MPI_Barrier(communicator);
          one.claim(log);
          other.claim(log);
          verdicts.same_text("one has", one.path(), "results");
          verdicts.same_text("the other has", other.path(), "results-2");
          verdicts.same_text(
            "--overwrite meanwhile",
            refusal(overwrite),
            "refused: The output folder \"results\" belongs to a run that is "
            "still going on; choose another \"Folder\" in section \"Output\".");
        }

        on_first(communicator, [] {
          fs::create_directories("results/a/fields");
          fs::create_directories("results/fields");
          fs::create_directories("results/checkpoint");
          for (const std::string name : {"histories.csv",
                                         "fields.pvd",
                                         "fields.txt",
                                         "fields/fields-00000001.vtu",
                                         "notes.txt",
                                         "a/parameters.prm",
                                         "a/histories.csv",
                                         "a/fields/fields-00000001.vtu"})
            std::ofstream("results/" + name) << "text\n";
        });
        {
          const auto bad = make_case(
            file.with({"Output/Folder=results", "Boundaries/Fixed=nowhere"}));
          std::string message = "accepted";
          try
            {
              make_simulation_with_files(*bad, communicator);
            }
          catch (const UserError &)
            {
              message = "refused";
            }
          verdicts.same_text("a bad case with --overwrite", message, "refused");
          verdicts.is_true("all results are there still",
                           text_of("results/histories.csv") == "text\n" &&
                             fs::exists("results/checkpoint"));
        }
        MPI_Barrier(communicator);
        verdicts.same_text("--overwrite after its end",
                           refusal(overwrite),
                           "claimed");
        for (const std::string name : {"histories.csv",
                                       "fields.pvd",
                                       "fields.txt",
                                       "fields/fields-00000001.vtu",
                                       "checkpoint"})
          verdicts.is_true(name + " is removed",
                           !fs::exists("results/" + name));
        for (const std::string name : {"notes.txt",
                                       "a/parameters.prm",
                                       "a/histories.csv",
                                       "a/fields/fields-00000001.vtu"})
          verdicts.is_true(name + " stays", fs::exists("results/" + name));
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<ResultFolders>
      registered("result folders", "Who may write to which folder.");
  } // namespace
} // namespace Voussoir
