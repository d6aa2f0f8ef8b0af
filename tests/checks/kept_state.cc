#include <filesystem>

#include "folders.h"
#include "same.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string kept = "kept/static_states";


    unsigned int
    n_files()
    {
      return std::distance(std::filesystem::directory_iterator(kept),
                           std::filesystem::directory_iterator());
    }


    void
    damage_files()
    {
      for (const auto &entry : std::filesystem::directory_iterator(kept))
        std::fstream(entry.path(),
                     std::ios::in | std::ios::out | std::ios::binary)
          .seekp(std::filesystem::file_size(entry) / 2)
          .write("damage", 6);
    }


    /** Points of the first material that have cracked in the static state. */
    unsigned int
    n_cracked(const StaticState &static_state, const MPI_Comm communicator)
    {
      const PointHistory *history = static_state.initial.material_memory.of(0);
      unsigned int        number  = 0;
      for (const auto &[cell, place] : history->cells())
        for (unsigned int q = 0; q < history->n_points(); ++q)
          number += history->band(place, q) > 0.;
      return Utilities::MPI::sum(number, communicator);
    }


    /**
     * A static state with joints and cracks is found once and kept: other runs
     * read it, on other numbers of ranks too, but not with another material or
     * from a damaged file.
     */
    class KeptState : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders({kept}, communicator);
        const auto marched = [&file](const std::string       &name,
                                     std::vector<std::string> changes,
                                     const MPI_Comm           ranks) {
          changes.push_back("Output/Folder=kept/" + name);
          std::pair<std::unique_ptr<Case>, std::unique_ptr<Simulation>> result;
          result.first  = make_case(file.with(changes));
          result.second = make_simulation_with_files(*result.first, ranks);
          result.second->run.march();
          return result;
        };
        // the wall time of a kept state is that of its computation
        const auto seconds = [](const auto &simulation) {
          return simulation.second->static_state.summary.at("seconds")
            .template get<double>();
        };

        const auto one = marched("one", {}, communicator);
        verdicts.is_true("the state is kept", n_files() == 1);
        verdicts.above("  points cracked in it",
                       n_cracked(one.second->static_state, communicator),
                       1.);

        const auto other = marched("other",
                                   {"Ground motion/Peak acceleration y=0.3",
                                    "Time/End time=0.02"},
                                   communicator);
        verdicts.is_true("another earthquake takes it",
                         seconds(other) == seconds(one) && n_files() == 1);
        const auto again = marched("again", {}, communicator);
        verdicts.is_true("the same run takes it",
                         seconds(again) == seconds(one));
        verdicts.is_true("  and is the same bit for bit",
                         same(again.second->run.state.displacement,
                              one.second->run.state.displacement));
        verdicts.is_true(
          "  with the warnings of the search for it",
          one.second->static_state.summary.contains("warnings") &&
            again.second->log.warnings() == one.second->log.warnings());
        on_first(communicator, [&] {
          verdicts.is_true("one rank alone takes it",
                           seconds(marched("alone", {}, MPI_COMM_SELF)) ==
                             seconds(one));
        });

        const auto stiffer = marched("stiffer",
                                     {"Materials/rock/Young's modulus=20e9"},
                                     communicator);
        verdicts.is_true("a run with other rock does not",
                         seconds(stiffer) != seconds(one) && n_files() == 2);
        const auto apart =
          marched("apart", {"Static state/Keep in="}, communicator);
        verdicts.is_true("nor does one that is to keep none",
                         seconds(apart) != seconds(one) && n_files() == 2);

        on_first(communicator, damage_files);
        verdicts.is_true("nor does any from a damaged file",
                         seconds(marched("damaged", {}, communicator)) !=
                           seconds(one));
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<KeptState>
      registered("kept state", "A static state that is kept and found again.");
  } // namespace
} // namespace Voussoir
