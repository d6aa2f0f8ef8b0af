#include <voussoir/base/error.h>
#include <voussoir/base/interruption.h>
#include <voussoir/base/machine.h>
#include <voussoir/base/text.h>
#include <voussoir/base/version.h>
#include <voussoir/driver/command_line.h>
#include <voussoir/driver/crack_refinement.h>
#include <voussoir/driver/shipped_cases.h>
#include <voussoir/driver/simulation.h>
#include <voussoir/driver/study.h>
#include <voussoir/driver/summary_preview.h>
#include <voussoir/driver/verdict_tables.h>

#include <deal.II/base/timer.h>

#include <CLI/CLI.hpp>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <regex>
#include <thread>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::map<std::string, ParameterHandler::OutputStyle> &
    default_formats()
    {
      static const std::map<std::string, ParameterHandler::OutputStyle> formats{
        {"prm", ParameterHandler::Text},
        {"short", ParameterHandler::ShortText},
        {"description", ParameterHandler::Description},
        {"json", ParameterHandler::JSON},
        {"xml", ParameterHandler::XML},
        {"latex", ParameterHandler::LaTeX}};
      return formats;
    }

    template <typename Base>
    void
    list(std::ostream &out)
    {
      for (const auto &[name, entry] : Registry<Base>::entries())
        out << name << ": " << entry.description << '\n';
    }

    const std::map<std::string, void (*)(std::ostream &)> &
    lists()
    {
      static const std::map<std::string, void (*)(std::ostream &)> all{
        {"cases", list_shipped_cases},
        {"materials", list<Material>},
        {"loads", list<Load>},
        {"constraints", list<Projection>},
        {"interfaces", list<InterfaceLaw>},
        {"observers", list<Observer>},
        {"meshes", list<MeshGenerator>}};
      return all;
    }

    void
    print(const ParameterHandler             &prm,
          const ParameterHandler::OutputStyle style,
          std::ostream                       &out)
    {
      std::ostringstream text;
      prm.print_parameters(text, style);
      // deal.II's parameter_gui would read the numbers of callbacks as entries
      out << (style == ParameterHandler::XML ?
                std::regex_replace(text.str(),
                                   std::regex("<actions>[^<]*</actions>"),
                                   "") :
                text.str());
    }


    /** Declares all entries: for each class a section of the same name. */
    void
    print_all_entries(std::ostream                       &out,
                      const ParameterHandler::OutputStyle style)
    {
      Case all;
      // one for each type of mesh, where a case has only one generator
      std::vector<std::unique_ptr<MeshGenerator>> generators;
      all.prm.enter_subsection("Mesh");
      for (const auto &[name, entry] : Registry<MeshGenerator>::entries())
        {
          generators.push_back(entry.create());
          all.prm.enter_subsection(name);
          generators.back()->declare_parameters(all.prm);
          all.prm.leave_subsection();
        }
      all.prm.enter_subsection("file");
      all.reader.declare(all.prm);
      all.prm.leave_subsection();
      all.prm.leave_subsection();
      print(all.prm, style, out);
    }

    template <typename Map>
    std::vector<std::string>
    keys(const Map &map)
    {
      std::vector<std::string> names;
      for (const auto &item : map)
        names.push_back(item.first);
      return names;
    }

    template <typename Map>
    const typename Map::mapped_type &
    choice(const Map &map, const std::string &option, const std::string &name)
    {
      const auto item = map.find(name);
      if (item == map.end())
        throw UserError(option + " cannot be \"" + name + "\"" +
                        known_names(name, keys(map)) + ".");
      return item->second;
    }

    /** Wall time of a step, measured in the first steps [s]. */
    double
    seconds_per_step(Run &run)
    {
      const auto  last  = std::min(run.n_steps(), 10ULL);
      double      total = 0.;
      const Timer clock;
      while (run.state.step < last && total < 1.)
        {
          run.scheme.step(run.state);
          total = Utilities::MPI::broadcast(run.log.communicator(),
                                            clock.wall_time());
        }
      return last > 0 ? total / double(run.state.step) : 0.;
    }


    /** Checks of a case without running it, and the estimate of its time. */
    struct Estimate
    {
      types::global_dof_index  unknowns  = 0;
      double                   time_step = 0., seconds = 0., megabytes = 0.;
      unsigned long long       steps = 0;
      std::vector<std::string> notes, warnings;
      nlohmann::json           checks;  // numerical ones
      std::string              refined; // where cracks are expected
    };


    Estimate
    estimate(const Case    &parameters,
             RunOptions     options,
             const MPI_Comm communicator)
    {
      options.quiet    = true;
      options.validate = true;
      Simulation simulation(parameters, options, communicator);
      Run       &run = simulation.run;
      check_summary_paths(run);
      const double seconds = double(run.n_steps()) * seconds_per_step(run);
      std::vector<std::string> notes     = parameters.notes;
      const auto               on_cracks = simulation.model.notes_on_cracks();
      for (unsigned int m = 0; m < on_cracks.size(); ++m)
        for (const std::string &note : on_cracks[m])
          notes.push_back("in " + parameters.materials.objects[m].first + ", " +
                          note);
      return {simulation.model.solid.discretization.dof_handler.n_dofs(),
              run.time_step.length,
              seconds,
              largest_memory(communicator),
              run.n_steps(),
              notes,
              simulation.log.warnings(),
              numerical_checks(*run.setup),
              describe_refinement(parameters,
                                  simulation.model.grid.refinement())};
    }


    void
    validate(const Case    &parameters,
             RunOptions     options,
             const MPI_Comm communicator)
    {
      const Estimate found = estimate(parameters, options, communicator);
      if (Utilities::MPI::this_mpi_process(communicator) > 0)
        return;
      for (const std::string &note : found.notes)
        std::cout << "note: " << note << '\n';
      for (const std::string &warning : found.warnings)
        std::cout << "Warning: " << warning << '\n';
      if (!found.refined.empty())
        std::cout << "Refined where cracks are expected: " << found.refined
                  << '\n';
      std::cout << description("Numerical checks known before", found.checks);
      std::cout << "Valid: " << found.unknowns << " unknowns, time step "
                << found.time_step << " s, " << found.steps << " steps"
                << (parameters.damping.modes.empty() ?
                      "" :
                      ", more with the damping that is fitted to the modes")
                << ".\nThe steps take about " << duration_text(found.seconds)
                << " on "
                << counted(Utilities::MPI::n_mpi_processes(communicator),
                           "rank",
                           "ranks")
                << ", static state, modes and output not counted, and at least "
                << std::lround(found.megabytes) << " MB of memory on each."
                << std::endl;
    }


    void
    validate_study(const ParameterFile &file,
                   const RunOptions    &options,
                   const MPI_Comm       communicator)
    {
      const auto runs = Study(file, options, communicator).planned_runs();
      // numbers that are moved by a small share do not change the time of a run
      const std::size_t n_tried =
        Case(file).study.moves_numbers() ? 1 : runs.size();
      double                   seconds = 0.;
      std::vector<std::string> texts; // of all runs, each once
      const auto               add = [&texts](const std::string &text) {
        if (std::find(texts.begin(), texts.end(), text) == texts.end())
          texts.push_back(text);
      };
      for (std::size_t i = 0; i < n_tried; ++i)
        {
          const Case     run(runs[i]);
          const Estimate found = estimate(run, options, communicator);
          seconds += found.seconds * runs.size() / n_tried;
          for (const std::string &note : found.notes)
            add("note: " + note + '\n');
          for (const std::string &warning : found.warnings)
            add("Warning: " + warning + '\n');
          if (!found.refined.empty())
            add("Refined where cracks are expected: " + found.refined + '\n');
          nlohmann::json missed;
          for (const std::string &name : not_met(found.checks))
            missed[name] = found.checks.at(name);
          add(description("Numerical checks not met, known before", missed));
        }
      if (Utilities::MPI::this_mpi_process(communicator) == 0)
        std::cout
          << join(texts, "") << "Valid: a study of "
          << counted(runs.size(), "run", "runs")
          << (Case(file).study.seeks_limit() ? " and values between them" : "")
          << ".\nTheir steps take about " << duration_text(seconds) << " on "
          << counted(Utilities::MPI::n_mpi_processes(communicator),
                     "rank",
                     "ranks")
          << ", static state, modes and output not counted." << std::endl;
    }


    // The stress-strain table of one material.
    void
    test_material(const Case        &parameters,
                  const std::string &csv_file,
                  const bool         overwrite)
    {
      const auto       &test      = parameters.material_test;
      const auto        names     = parameters.material_names();
      const auto        materials = parameters.material_list();
      const std::string name = test.material.empty() ? names[0] : test.material;
      const auto        place = std::find(names.begin(), names.end(), name);
      if (place == names.end())
        throw UserError("\"Material\" in section \"Material test\" is \"" +
                        name + "\"" + known_names(name, names) + ".");
      if (std::filesystem::exists(csv_file) && !overwrite)
        throw UserError("\"" + csv_file +
                        "\" exists; give another name, or \"--overwrite\".");
      std::ostringstream table;
      test.run(*materials[place - names.begin()], table);
      if (const std::string reason = write_file(csv_file, table.str());
          !reason.empty())
        throw UserError("\"" + csv_file + "\" cannot be written because " +
                        reason + "; give another name.");
      std::cout << "The test of material \"" << name << "\" is in " << csv_file
                << std::endl;
    }
  } // namespace


  namespace
  {
    /** Whether all ranks reach this call within a few seconds. */
    bool
    all_arrive(const MPI_Comm communicator)
    {
      MPI_Request request;
      MPI_Ibarrier(communicator, &request);
      const Timer clock(MPI_COMM_SELF);
      int         arrived = 0;
      while (!arrived && clock.wall_time() < 5.)
        {
          MPI_Test(&request, &arrived, MPI_STATUS_IGNORE);
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
      return arrived != 0;
    }
  } // namespace


  int
  guarded(const std::function<void()> &action, const MPI_Comm communicator)
  {
    const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;
    // to meet after an error, as ranks may wait for each other on the usual
    // communicator
    MPI_Comm meeting;
    MPI_Comm_dup(communicator, &meeting);
    std::string message;
    int         code = 1;
    try
      {
        action();
        return 0;
      }
    catch (const IncompleteStudy &error)
      {
        message = error.what();
        code    = exit_code_incomplete;
      }
    catch (const UserError &error)
      {
        message = error.what();
      }
    catch (const Stopped &stopped)
      {
        // all ranks stop together
        if (first)
          std::cout << stopped.what() << std::endl;
        return exit_code_stopped;
      }
    catch (const std::bad_alloc &)
      {
        message = "There is not enough memory for this case; use fewer cells, "
                  "or more machines.";
      }
    catch (const std::exception &error)
      {
        message =
          std::string("Unexpected error, please report it: ") + error.what();
      }
    // The first rank reports an error that all ranks have. An error of one rank
    // cannot be shared with the others, which wait in another call.
    const bool all = all_arrive(meeting);
    if (first || !all)
      std::cerr << "Error: " << message << std::endl;
    if (!all)
      MPI_Abort(communicator, code);
    return code;
  }


  namespace
  {
    /** The arguments. */
    struct Arguments
    {
      std::string              case_file, defaults, what, test_file;
      std::vector<std::string> changes;
      bool                     only_validate = false;
      RunOptions               options;
    };


    void
    declare(CLI::App &app, Arguments &arguments)
    {
      app.set_version_flag("--version", version());
      app.add_option("case", arguments.case_file, "Parameter file of the case");
      app.add_option("--set",
                     arguments.changes,
                     "Change entries: \"Section/Entry=value\", one or several; "
                     "may be given several times");
      app.add_flag("--validate",
                   arguments.only_validate,
                   "Check everything about the case without running it");
      app.add_option("--defaults",
                     arguments.defaults,
                     "Print all entries of the case with their values and "
                     "descriptions, or without a case those of every class, "
                     "as " +
                       join(keys(default_formats()), ", "));
      app.add_option("--list",
                     arguments.what,
                     "Print the classes of one kind, or the shipped cases: " +
                       join(keys(lists()), ", "));
      app.add_option("--material-test",
                     arguments.test_file,
                     "Apply the path of section \"Material test\" to one "
                     "point of a material and write strains and stresses to "
                     "this CSV file");
      app.add_flag(
        "--restart",
        arguments.options.restart,
        "Continue from the last checkpoint of the newest output folder");
      app.add_flag("--overwrite",
                   arguments.options.overwrite,
                   "Replace the results in an earlier output folder instead "
                   "of adding a number to its name");
    }


    /** "--set A=1 B=2 case.prm": the argument without "=" is the case. */
    void
    take_case_from_changes(Arguments &arguments)
    {
      auto &changes = arguments.changes;
      if (arguments.case_file.empty() && !changes.empty() &&
          changes.back().find('=') == std::string::npos)
        {
          arguments.case_file = changes.back();
          changes.pop_back();
        }
    }


    void
    do_as_told(const Arguments &arguments, const MPI_Comm communicator)
    {
      const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;
      if (!arguments.what.empty())
        {
          const auto print = choice(lists(), "--list", arguments.what);
          if (first)
            print(std::cout);
          return;
        }
      const auto style =
        arguments.defaults.empty() ?
          ParameterHandler::Text :
          choice(default_formats(), "--defaults", arguments.defaults);
      if (arguments.case_file.empty() && arguments.defaults.empty())
        throw UserError("No parameter file is given; write \"voussoir "
                        "case.prm\", or see \"voussoir --help\".");
      if (arguments.case_file.empty())
        {
          if (first)
            print_all_entries(std::cout, style);
          return;
        }
      const std::string file = find_case(arguments.case_file);
      if (first && file != arguments.case_file)
        std::cerr << "There is no file \"" << arguments.case_file
                  << "\" here; the shipped case is taken: " << file
                  << std::endl;
      Case parameters(ParameterFile(file, arguments.changes));
      if (!arguments.defaults.empty())
        {
          if (first)
            print(parameters.prm, style, std::cout);
        }
      else if (!arguments.test_file.empty())
        {
          if (first)
            test_material(parameters,
                          arguments.test_file,
                          arguments.options.overwrite);
        }
      else if (arguments.only_validate && parameters.study.wanted())
        validate_study(parameters.file, arguments.options, communicator);
      else if (arguments.only_validate)
        validate(parameters, arguments.options, communicator);
      else if (parameters.study.wanted())
        {
          listen_to_signals();
          Study(parameters.file, arguments.options, communicator).run();
        }
      else
        {
          listen_to_signals();
          Simulation simulation(parameters, arguments.options, communicator);
          simulation.run.march();
        }
    }
  } // namespace


  int
  run_command_line(const int argc, char **argv, const MPI_Comm communicator)
  {
    CLI::App  app{"Voussoir: seismic response of arch dams, from a parameter "
                  "file. Run it under mpirun for several ranks.",
                 "voussoir"};
    Arguments arguments;
    declare(app, arguments);

    const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;
    try
      {
        app.parse(argc, argv);
        take_case_from_changes(arguments);
      }
    catch (const CLI::ParseError &error)
      {
        // --help and --version end here, too
        std::ostringstream text;
        const int          code = app.exit(error, text, text);
        if (first && code == 0)
          std::cout << text.str() << std::flush;
        else if (first)
          std::cerr << "Error: " << error.what() << "; see \"voussoir --help\"."
                    << std::endl;
        return code == 0 ? 0 : 1;
      }
    return guarded([&] { do_as_told(arguments, communicator); }, communicator);
  }
} // namespace Voussoir
