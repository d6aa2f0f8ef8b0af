#include <voussoir/analysis/lost_equilibrium.h>
#include <voussoir/base/version.h>
#include <voussoir/driver/kept_states.h>
#include <voussoir/driver/simulation.h>
#include <voussoir/driver/stored_rest.h>
#include <voussoir/driver/summary_file.h>
#include <voussoir/output/field_writer.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A log that has said who speaks. */
    Log
    opened_log(const Case       &parameters,
               const RunOptions &options,
               const MPI_Comm    communicator)
    {
      Log log(communicator, options.quiet);
      log.line("Voussoir ",
               version(),
               " with deal.II " DEAL_II_PACKAGE_VERSION);
#ifdef DEBUG
      log.line("DEBUG build: every check is on, and it is some thirty times "
               "slower than a Release build.");
#endif
      log.line("Ranks: ",
               Utilities::MPI::n_mpi_processes(communicator),
               " of one thread, SIMD: ",
               simd_description());
      if (!parameters.title.empty())
        log.line(parameters.title);
      return log;
    }


    /** Refuses what cannot be computed or recorded before that costs time or
     *  leaves something behind; then the folder is that of this run. */
    std::unique_ptr<RunSetup>
    checked_setup(const Model      &model,
                  ResultFolder     &folder,
                  const RunOptions &options,
                  Log              &log)
    {
      const Case &parameters = model.parameters;
      if (parameters.modes.number > 0 && parameters.damping.depends_on_modes())
        log.line("Before the modes are known, ",
                 parameters.damping.follows_first_mode() ?
                   "with moduli of another frequency:" :
                   "without damping:");
      auto setup = std::make_unique<RunSetup>(model, Modes(), folder, log);
      check_modes(model);
      if (folder.wanted() && !options.validate)
        folder.claim(log);
      return setup;
    }


    /** Takes what the run that goes on from its checkpoint has stored in the
     *  file, or else finds and stores it, so that no restart finds it again. */
    template <typename Result>
    Result
    stored_or_found(const Model        &model,
                    const ResultFolder &folder,
                    const std::string  &name,
                    Result (*read)(const Model &, const std::string &),
                    const std::function<Result()> &find,
                    void (*store)(const Model &,
                                  const Result &,
                                  const std::string &),
                    Log &log)
    {
      const std::string file = folder.checkpoints() + "/" + name;
      if (folder.exists() && folder.restarts() &&
          damage_of_state(file, log.communicator()).empty())
        {
          log.line("Taken from ", file);
          return read(model, file);
        }
      const Result result = find();
      if (folder.exists() && model.parameters.output.has_checkpoints())
        try
          {
            store(model, result, file);
          }
        catch (const UserError &error)
          {
            log.warn("a restart will have to find this again: ", error.what());
          }
      return result;
    }


    RestState
    kept_or_found(const Model &model, const ResultFolder &folder, Log &log)
    {
      const KeptStates kept(model, folder, log);
      if (std::optional<RestState> rest = kept.find())
        return std::move(*rest);
      RestState rest = find_rest(model, log);
      kept.keep(rest);
      // as all later runs, whatever their number of ranks, have it
      if (model.solid.discretization.reproducible)
        {
          if (std::optional<RestState> again = kept.find())
            return std::move(*again);
          log.warn("the static state is not kept, so that \"Sums = "
                   "reproducible\" holds for this number of ranks alone");
        }
      return rest;
    }


    /** Draws the last state that had an equilibrium and the motion from there,
     *  and passes the error on. */
    [[noreturn]] void
    report_lost(const LostEquilibrium &lost,
                const RunSetup        &setup,
                const ResultFolder    &folder,
                Log                   &log)
    {
      const RestState     rest(setup.model);
      const ObservedModel observed =
        setup.observed(folder.path(),
                       rest.initial,
                       rest.initial.material_memory,
                       nullptr,
                       log);
      const std::string picture =
        write_fields(observed,
                     {{&lost.before, {"displacement"}},
                      {&lost.moved, {"displacement when it was given up"}}},
                     nullptr,
                     "last_good",
                     0.);
      write_summary(folder.path(),
                    setup.summary(log.communicator()),
                    std::string("stopped: ") + lost.what(),
                    log);
      throw RunStopped(std::string(lost.what()) +
                       (picture.empty() ?
                          "" :
                          " The state before this stage and the "
                          "motion from there are in " +
                            folder.path() + "/" + picture + "."));
    }


    RestState
    rest_of(const RunSetup &setup, const ResultFolder &folder, Log &log)
    {
      const Model &model = setup.model;
      if (model.parameters.static_state.stage_names().empty())
        return RestState(model);
      try
        {
          return stored_or_found<RestState>(
            model,
            folder,
            "rest.h5",
            read_rest,
            [&] { return kept_or_found(model, folder, log); },
            [](const Model       &model,
               const RestState   &rest,
               const std::string &file) { store_rest(model, rest, file); },
            log);
        }
      catch (const LostEquilibrium &lost)
        {
          if (!folder.exists())
            throw;
          report_lost(lost, setup, folder, log);
        }
    }


    Modes
    modes_of(const Model        &model,
             const RestState    &rest,
             const ResultFolder &folder,
             Log                &log)
    {
      if (model.parameters.modes.number == 0)
        return {};
      return stored_or_found<Modes>(
        model,
        folder,
        "modes.h5",
        read_modes,
        [&] { return find_modes(model, rest, log); },
        store_modes,
        log);
    }


    /** The setup again, if it depends on the modes. */
    std::unique_ptr<RunSetup>
    adapted_setup(std::unique_ptr<RunSetup> setup,
                  const Modes              &modes,
                  const ResultFolder       &folder,
                  Log                      &log)
    {
      const Model &model = setup->model;
      if (!model.parameters.damping.depends_on_modes() || modes.list.empty())
        return setup;
      return std::make_unique<RunSetup>(model, modes, folder, log);
    }
  } // namespace


  Simulation::Simulation(const Case       &parameters,
                         const RunOptions &options,
                         const MPI_Comm    communicator)
    : log(opened_log(parameters, options, communicator))
    , folder(parameters, options, log)
    , model(parameters, log)
    , checked(checked_setup(model, folder, options, log))
    , found(options.validate ? RestState(model) :
                               rest_of(*checked, folder, log))
    , modes(options.validate ? Modes() : modes_of(model, found, folder, log))
    , setup(adapted_setup(std::move(checked), modes, folder, log))
    , rest(handed_over(std::move(found), model, setup->internal_force, log))
    , run(rest, modes, folder, std::move(setup), log)
  {}


  Simulation::~Simulation() = default;
} // namespace Voussoir
