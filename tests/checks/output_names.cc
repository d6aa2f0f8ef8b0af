#include <voussoir/output/observer.h>

#include <filesystem>
#include <fstream>

#include "check.h"
#include "same.h"

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    /** An observer with some entries. */
    std::unique_ptr<Observer>
    make_observer(const std::string                        &name,
                  const std::map<std::string, std::string> &entries)
    {
      auto             observer = Registry<Observer>::create(name, "the check");
      ParameterHandler prm;
      observer->declare_parameters(prm);
      for (const auto &[entry, value] : entries)
        prm.set(entry, value);
      return observer;
    }


    ObservedRun
    model_with_folder(const Simulation &simulation, const std::string &folder)
    {
      ObservedRun model = simulation.run.observed;
      model.folder      = folder;
      if (Utilities::MPI::this_mpi_process(
            simulation.model.grid.communicator()) == 0)
        fs::create_directories(folder);
      MPI_Barrier(simulation.model.grid.communicator());
      return model;
    }


    /** The array of strings of this name in a VTU file. */
    std::vector<std::string>
    strings_in(const std::string &file, const std::string &name)
    {
      const std::string text  = text_of(file);
      const auto        array = text.find("Name=\"" + name + '"');
      if (array == std::string::npos)
        return {};
      std::istringstream       in(text.substr(text.find('>', array) + 1));
      std::vector<std::string> strings(1);
      for (int byte; in >> byte;)
        if (byte == 0)
          strings.emplace_back();
        else
          strings.back() += static_cast<char>(byte);
      strings.pop_back();
      return strings;
    }


    /** All numbers in results refer to one table of names. */
    class NamesInResults : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto  parameters = make_case(file);
        const auto  simulation = make_simulation(*parameters, communicator);
        const auto  model      = model_with_folder(*simulation, "observed");
        const auto &names      = model.names;
        const auto  summary    = names.json();
        verdicts.is_true("materials in the order of their section",
                         names.materials == parameters->material_names());
        verdicts.is_true("interfaces in the order of the contact surfaces",
                         names.interfaces ==
                           simulation->run.contact->surface_names());
        verdicts.is_true("interfaces in the order of the file",
                         names.interfaces ==
                           std::vector<std::string>(
                             {"joint 3", "joint 4", "joint 1", "joint 2"}));

        bool        in_blocks   = true;
        const Grid &grid        = simulation->model.grid;
        const auto  dam         = grid.tags_in({"dam"});
        const auto  set_of_cell = smallest_cell_sets(grid, names.cell_sets);
        for (const auto &cell :
             simulation->model.grid.triangulation().active_cell_iterators())
          if (cell->is_locally_owned())
            {
              const std::string set =
                names.cell_sets.at(set_of_cell[cell->active_cell_index()]);
              in_blocks =
                in_blocks && grid.tags_in({set})[cell->material_id()] &&
                (dam[cell->material_id()] ? set.rfind("block ", 0) == 0 :
                                            set == "rock");
            }
        verdicts.is_true("the smallest set of a cell is its block, or rock",
                         Utilities::MPI::min(in_blocks ? 1 : 0, communicator) ==
                           1);

        const std::string sets  = "upstream face, downstream face";
        const std::string point = "rock, \"deep\"";
        for (const auto &[name, entries] :
             std::map<std::string, std::map<std::string, std::string>>{
               {"fields", {{"Times", "0"}}},
               {"face stresses", {{"Face sets", sets}}},
               {"interfaces", {}},
               {"histories",
                {{"Points", point + ": 1 2 -100; shallow: 1 2 -50"},
                 {"Relative to", point},
                 {"Quantities", "velocity"}}}})
          {
            const auto observer = make_observer(name, entries);
            observer->check(model);
            observer->begin(model);
            observer->observe(simulation->run.state);
            nlohmann::json nothing;
            observer->finish(simulation->run.state, nothing);
          }
        MPI_Barrier(communicator);

        const std::string fields = "observed/fields/fields-00000000.vtu",
                          faces  = "observed/face_stress_envelopes.vtu",
                          joints = "observed/interface_envelopes.vtu";
        const auto same          = [&](const std::string &name,
                              const std::string &vtu,
                              const std::string &array,
                              const std::string &kind) {
          verdicts.is_true(name,
                           summary.at(kind) ==
                             strings_in(vtu, array + "_names"));
        };
        same("materials in fields", fields, "material", "materials");
        same("cell sets in fields", fields, "cell_set", "cell sets");
        same("face sets on faces", faces, "face_set", "face sets");
        same("interfaces on their faces", joints, "interface", "interfaces");
        same("their states", joints, "state", "interface states");

        std::string heading = text_of("observed/interfaces.csv");
        std::size_t place   = 0;
        bool        ordered = true;
        for (const std::string &name : names.interfaces)
          {
            place   = heading.find(',' + name + " largest opening", place);
            ordered = ordered && place != std::string::npos;
          }
        verdicts.is_true("columns of interfaces.csv in their order", ordered);
        heading             = text_of("observed/histories.csv");
        std::string columns = "time [s]";
        for (const std::string of :
             {"rock, \"\"deep\"\" velocity @ [m/s]",
              "shallow velocity @ relative to rock, \"\"deep\"\" [m/s]"})
          for (const char d : {'x', 'y', 'z'})
            columns +=
              ",\"" + std::string(of).replace(of.find('@'), 1, 1, d) + '"';
        verdicts.same_text("columns of histories.csv",
                           heading.substr(0, heading.find('\n')),
                           columns);
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<NamesInResults>
      names_in_results("names in results", "One table of names.");


    /**
     * An observer that has been used in a run, or a part of one, gives, for
     * another run, the same results as a new observer.
     */
    class ObserversAgain : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        std::vector<State> states{simulation->run.state};
        for (unsigned int i = 0; i < 20; ++i)
          {
            simulation->run.scheme.step(simulation->run.state);
            states.push_back(simulation->run.state);
          }
        const std::string points = "middle, top: 2 2 0.9; base: 2 2 0";
        for (const auto &[name, entries] :
             std::map<std::string, std::map<std::string, std::string>>{
               {"fields", {{"Interval", "1e-6"}}},
               {"envelopes", {{"Interval", "1e-6"}}},
               {"face stresses",
                {{"Face sets", "front, back"},
                 {"Interval", "1e-6"},
                 {"Envelope interval", "1e-6"}}},
               {"section forces",
                {{"Sections", "middle: 2.1 0.7"},
                 {"Upstream", "back"},
                 {"Downstream", "front"},
                 {"Interval", "1e-6"}}},
               {"interfaces",
                {{"Points", "corner, first: 0 0 0.5"},
                 {"Blocks", "block: plane"},
                 {"Interval", "1e-6"}}},
               {"histories", {{"Points", points}, {"Interval", "1e-6"}}},
               {"response spectra",
                {{"Points", points},
                 {"Reference", "base"},
                 {"Interval", "1e-6"}}}})
          {
            const auto once  = model_with_folder(*simulation, "observed/once");
            const auto again = model_with_folder(*simulation, "observed/again");
            const auto expected =
              seen(*make_observer(name, entries), once, states);

            const auto observer = make_observer(name, entries);
            seen(*observer, again, states); // a whole run before
            observer->begin(again);
            for (unsigned int i = 5; i < 15; ++i) // and one that was stopped
              observer->observe(states[i]);
            const auto summary = seen(*observer, again, states);

            MPI_Barrier(communicator);
            verdicts.is_true(name + ": same summary", summary == expected);
            verdicts.is_true(name + ": same files",
                             files_in("observed/once") ==
                               files_in("observed/again"));
            MPI_Barrier(communicator);
          }
      }

    private:
      static nlohmann::json
      seen(Observer                 &observer,
           const ObservedRun        &model,
           const std::vector<State> &states)
      {
        observer.begin(model);
        for (const State &state : states)
          observer.observe(state);
        nlohmann::json summary;
        observer.finish(states.back(), summary);
        return summary;
      }

      /** Name and text of each file, without the lines in which deal.II writes
       *  the time. */
      static std::map<std::string, std::string>
      files_in(const std::string &folder)
      {
        std::map<std::string, std::string> files;
        for (const auto &entry : fs::recursive_directory_iterator(folder))
          if (entry.is_regular_file())
            {
              std::istringstream in(text_of(entry.path()));
              std::string       &text =
                files[fs::relative(entry.path(), folder).string()];
              for (std::string line; std::getline(in, line);)
                if (line.rfind('#', 0) != 0)
                  text += line + '\n';
            }
        return files;
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<ObserversAgain>
      observers_again("observers again", "Observers of two runs.");
  } // namespace
} // namespace Voussoir
