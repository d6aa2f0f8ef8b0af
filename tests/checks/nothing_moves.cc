#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A model without excitation: modes alone are computed without steps, and
     *  steps alone give a warning. The result of a run equals summary.json,
     *  also when this file is read again. */
    class NothingMoves : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto summary_of = [&](const ParameterFile &changed) {
          return this->summary_of(changed, verdicts, communicator);
        };
        const auto modes = summary_of(file);
        verdicts.is_true("modes alone: no steps", modes["steps"] == 0);
        verdicts.is_true("modes alone: they are in the summary",
                         modes["modes"]["modes"].size() == 2);
        verdicts.is_true("modes alone: no warning", modes["warnings"].empty());

        const auto rest = summary_of(file.with({"Modes/Number=0"}));
        verdicts.is_true("without modes: steps", rest["steps"] > 0);
        verdicts.is_true("without modes: one warning, in the verdict",
                         rest["warnings"].size() == 1 &&
                           rest["verdict"] == "with warnings, see there");

        const auto pushed = summary_of(file.with({"Loads/Names=push",
                                                  "Loads/push/Face sets=top",
                                                  "Loads/push/Pressure=1e5"}));
        verdicts.is_true("modes and a load: steps", pushed["steps"] > 0);
        verdicts.is_true("modes and a load: no warning",
                         pushed["warnings"].empty());

        const char *balance = "time of cells, largest over mean of the ranks";
        const bool  is_shared =
          Utilities::MPI::n_mpi_processes(communicator) > 1;
        verdicts.is_true(
          "time of cells: compared where there are several ranks",
          pushed.contains(balance) == is_shared);
        if (is_shared)
          verdicts.is_true("time of cells: from the mean to less than twice it",
                           pushed[balance] >= 1. && pushed[balance] < 2.);
      }

    private:
      static nlohmann::json
      summary_of(const ParameterFile &file,
                 Verdicts            &verdicts,
                 const MPI_Comm       communicator)
      {
        const std::string folder = "nothing_moves_output";
        const auto        parameters =
          make_case(file.with({"Output/Folder=" + folder}));
        const RunSummary summary =
          make_simulation_with_files(*parameters, communicator)->run.march();
        const nlohmann::json written = read_summary(folder);
        // as texts, as JSON has no infinite numbers
        verdicts.is_true("the summary that is returned is written",
                         nlohmann::json(summary).dump() == written.dump());
        verdicts.is_true("and read again",
                         nlohmann::json(written.get<RunSummary>()).dump() ==
                           written.dump());
        return written;
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<NothingMoves>
      registered("nothing moves", "A case without earthquake and load.");
  } // namespace
} // namespace Voussoir
