#include <filesystem>

#include "check.h"
#include "folders.h"
#include "same.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Two runs on one model with joints that open and slip, concrete that
     * cracks and a static state, which take their steps in turn: each equals
     * the run of another model alone, bit for bit, in its state and in its
     * files.
     */
    class SecondRun : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders({"twice", "twice-2", "twice-3"}, communicator);

        const auto parameters = make_case(file.with({"Output/Folder=twice"}));
        RunOptions options;
        options.quiet = true;
        Simulation alone(*parameters, options, communicator);
        alone.run.march();

        Simulation   simulation(*parameters, options, communicator);
        Run         &first = simulation.run;
        ResultFolder folder(*parameters, options, simulation.log);
        folder.claim(simulation.log);
        Run second(simulation.model,
                   simulation.static_state,
                   simulation.modes,
                   folder,
                   simulation.log);
        first.begin();
        second.begin();
        while (first.state.step < first.n_steps())
          {
            first.step();
            second.step();
          }
        first.end();
        second.end();

        // the energy of chaotic cracks differs between processors
        verdicts.is_true("cracks took more than a kilojoule",
                         first.energy.latest().material > 1e3);
        double opening = 0.;
        for (const ContactPoint &point : first.contact->points())
          keep_largest(opening, point.history.opening);
        verdicts.is_true("joints opened by more than a tenth of a millimetre",
                         Utilities::MPI::max(opening, communicator) > 1e-4);

        for (const auto &[name, run] :
             {std::make_pair(std::string("first"), &first),
              std::make_pair(std::string("second"), &second)})
          compare(name, *run, alone.run, communicator, verdicts);
        for (const std::string table :
             {"histories.csv", "energy.csv", "interfaces.csv"})
          for (const std::string folder : {"twice-2", "twice-3"})
            verdicts.is_true("same " + table + " in " + folder,
                             text_of("twice/" + table).size() > 1000 &&
                               text_of("twice/" + table) ==
                                 text_of(folder + "/" + table));
      }

    private:
      static void
      compare(const std::string &name,
              Run               &run,
              Run               &alone,
              const MPI_Comm     communicator,
              Verdicts          &verdicts)
      {
        verdicts.is_true(name + ": same displacement",
                         same(run.state.displacement,
                              alone.state.displacement));
        verdicts.is_true(name + ": same velocity",
                         same(run.state.velocity, alone.state.velocity));
        verdicts.is_true(name + ": same damping memory",
                         !run.state.memory.empty() &&
                           same(run.state.memory[0], alone.state.memory[0]));
        verdicts.is_true(name + ": same contact",
                         same(run.contact->checkpoint_values(),
                              alone.contact->checkpoint_values(),
                              communicator));
        verdicts.is_true(
          name + ": same cracks",
          same(run.state.material_memory.of(0)->checkpoint_values(),
               alone.state.material_memory.of(0)->checkpoint_values(),
               communicator));
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<SecondRun>
      registered("second run", "Two runs on one model, in turn, are as alone.");
  } // namespace
} // namespace Voussoir
