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
     * Two runs, one after the other, on one model with joints that open and
     * slip, concrete that cracks and a static state: the second is the first,
     * bit for bit, in its state and in its files.
     */
    class SecondRun : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders({"twice", "twice-2"}, communicator);

        const auto parameters = make_case(file.with({"Output/Folder=twice"}));
        RunOptions options;
        options.quiet = true;
        Simulation simulation(*parameters, options, communicator);
        Run       &first = simulation.run;
        first.march();
        ResultFolder folder(*parameters, options, simulation.log);
        folder.claim(simulation.log);
        Run second(simulation.model,
                   simulation.rest,
                   simulation.modes,
                   folder,
                   simulation.log);
        second.march();

        // what chaotic cracks amount to differs between processors
        verdicts.is_true("cracks took more than a kilojoule",
                         first.energy.latest().material > 1e3);
        double opening = 0.;
        for (const ContactPoint &point : first.contact->points())
          keep_largest(opening, point.history.opening);
        verdicts.is_true("joints opened by more than a tenth of a millimetre",
                         Utilities::MPI::max(opening, communicator) > 1e-4);

        verdicts.is_true("same displacement",
                         same(first.state.displacement,
                              second.state.displacement));
        verdicts.is_true("same velocity",
                         same(first.state.velocity, second.state.velocity));
        verdicts.is_true("same damping memory",
                         !first.state.memory.empty() &&
                           same(first.state.memory[0], second.state.memory[0]));
        verdicts.is_true("same contact",
                         same(first.contact->checkpoint_values(),
                              second.contact->checkpoint_values(),
                              communicator));
        PointHistory *cracks       = first.state.material_memory.of(0),
                     *cracks_again = second.state.material_memory.of(0);
        verdicts.is_true("same cracks",
                         same(cracks->checkpoint_values(),
                              cracks_again->checkpoint_values(),
                              communicator));
        for (const std::string table :
             {"histories.csv", "energy.csv", "interfaces.csv"})
          verdicts.is_true("same " + table,
                           text_of("twice/" + table).size() > 1000 &&
                             text_of("twice/" + table) ==
                               text_of("twice-2/" + table));
      }
    };

    // Reference: ourselves
    const Registry<Check>::Add<SecondRun>
      registered("second run", "Two runs on one model are the same.");
  } // namespace
} // namespace Voussoir
