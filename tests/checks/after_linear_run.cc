#include "folders.h"
#include "quiet_options.h"
#include "same.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A run after the linear run that chooses where cells are refined: a second
     * run takes the linear run from its folder, and a restart to a later end
     * time does so, too, and goes on bit for bit.
     */
    class AfterLinearRun : public Check
    {
    public:
      void
      run(const ParameterFile &of_test,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        // without the section of the check, as the program reads it again
        const ParameterFile file(
          of_test.folder() + "/../data/shaken_column.prm",
          // an entry of the material that the linear run does not have
          {"Materials/concrete/Crack growth=from tips"});
        remove_folders(
          {"once", "once-2", "once-linear", "halves", "halves-linear"},
          communicator);
        const Case once(file.with({"Output/Folder=once"}));
        {
          Log         log(communicator, true);
          const Model unrefined(once, log);
          verdicts.is_true("before the linear run: the mesh as given",
                           unrefined.grid.refinement().before == 0);
        }
        Simulation straight(once, quiet_options(false), communicator);
        straight.run.march();
        const RefinementSummary refined = straight.model.grid.refinement();
        verdicts.is_true("a part of the cells is chosen",
                         refined.chosen > 0 && refined.chosen < refined.before);
        verdicts.is_true("and refined", refined.after > refined.before);
        const nlohmann::json linear = read_summary("once-linear"),
                             whole  = read_summary("once");
        verdicts.is_true("the linear run has the cells as given",
                         linear.at("cells") == refined.before);
        verdicts.is_true("and no cracks", !linear.contains("materials"));
        verdicts.is_true("summary.json has the number of chosen cells",
                         whole.at("refined where cracks are expected")
                             .at("cells chosen") == refined.chosen);

        const auto made =
          std::filesystem::last_write_time("once-linear/largest_tension.h5");
        MPI_Barrier(communicator);
        Simulation again(once, quiet_options(false), communicator);
        verdicts.is_true("a second run takes the linear run",
                         std::filesystem::last_write_time(
                           "once-linear/largest_tension.h5") == made);
        verdicts.is_true("  and has the same cells",
                         again.model.grid.refinement().after == refined.after);

        const double end = once.time.end_time;
        const Case   shorter(
          file.with({"Output/Folder=halves",
                       "Time/End time=" + std::to_string(0.6 * end)}));
        Simulation(shorter, quiet_options(false), communicator).run.march();
        const Case longer(file.with({"Output/Folder=halves"}));
        Simulation going_on(longer, quiet_options(true), communicator);
        verdicts.is_true("a restart goes on",
                         going_on.run.state.time > 0.3 * end);
        going_on.run.march();
        verdicts.is_true("  to the same displacement, bit for bit",
                         same(straight.run.state.displacement,
                              going_on.run.state.displacement));
        verdicts.is_true("  which is not zero",
                         straight.run.state.displacement.linfty_norm() > 1e-4);
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<AfterLinearRun>
      registered("after linear run",
                 "Runs on a mesh that a linear run has chosen, and restarts.");
  } // namespace
} // namespace Voussoir
