#include <voussoir/analysis/lost_equilibrium.h>
#include <voussoir/base/version.h>
#include <voussoir/driver/crack_refinement.h>
#include <voussoir/driver/kept_states.h>
#include <voussoir/driver/simulation.h>
#include <voussoir/driver/stored_static_state.h>
#include <voussoir/output/field_writer.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A log that begins with the program and its version. */
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
      log.line(
        "DEBUG build: all checks are on, and it is some thirty times slower "
        "than a Release build.");
#endif
      log.line("Ranks: ",
               Utilities::MPI::n_mpi_processes(communicator),
               " of one thread, SIMD: ",
               simd_description());
      if (!parameters.title.empty())
        log.line(parameters.title);
      return log;
    }


    /** The setup, unless damping is fitted to modes that are not known yet;
     *  then the time step is checked as far as possible, before time is spent
     *  or files are written. After that the folder is claimed for this run. */
    std::unique_ptr<RunSetup>
    early_setup(RunPlan          &plan,
                ResultFolder     &folder,
                const RunOptions &options,
                Log              &log)
    {
      const Case &parameters = plan.model.parameters;
      check_modes(plan.model);
      if (!parameters.static_state.stage_names().empty())
        check_stage_results(plan.model.solid.discretization,
                            parameters.static_state);
      const bool needs_modes =
        parameters.modes.number > 0 && parameters.damping.depends_on_modes();
      const bool waits = needs_modes && !options.validate;
      if (needs_modes)
        log.line("Before the modes are known, ",
                 !waits && parameters.damping.follows_first_mode() ?
                   "with moduli of another frequency:" :
                   "without damping:");
      std::unique_ptr<RunSetup> setup;
      if (waits)
        check_without_damping(plan, folder, log);
      else
        setup =
          std::make_unique<RunSetup>(std::move(plan), Modes(), folder, log);
      if (folder.wanted() && !options.validate)
        folder.claim(log);
      return setup;
    }


    /** Reads the result that the interrupted run has stored in the file, or
     *  else computes and stores it, so that a restart need not compute it
     *  again.
     */
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
            log.warn("a restart will have to compute this again: ",
                     error.what());
          }
      return result;
    }


    /** Those of a result that may have been stored. */
    void
    warn_of(const std::vector<std::string> &warnings, Log &log)
    {
      for (const std::string &warning : warnings)
        log.warn(warning);
    }


    StaticState
    kept_or_found(const Model &model, const ResultFolder &folder, Log &log)
    {
      const KeptStates kept(model, folder, log);
      if (std::optional<StaticState> static_state = kept.find())
        return std::move(*static_state);
      StaticState static_state = find_static_state(model, log);
      kept.keep(static_state);
      // as later runs read it, on any number of ranks
      if (model.solid.discretization.reproducible)
        {
          if (std::optional<StaticState> again = kept.find())
            return std::move(*again);
          log.warn("the static state is not kept, so that \"Sums = "
                   "reproducible\" holds for this number of ranks alone");
        }
      return static_state;
    }


    /** Writes a picture of the last state in equilibrium and of the motion from
     *  it, and throws the error again. */
    [[noreturn]] void
    report_lost(const LostEquilibrium &lost,
                const RunPlan         &plan,
                const RunSetup        *setup,
                const ResultFolder    &folder,
                Log                   &log)
    {
      const std::string picture =
        write_fields(plan.observed(log),
                     folder.path(),
                     {{&lost.before, {"displacement"}},
                      {&lost.moved, {"displacement when it was given up"}}},
                     "last_good");
      RunSummary summary;
      summary.end    = RunEnd::stopped;
      summary.reason = lost.what();
      summary.model  = summary_of(plan.model);
      if (setup != nullptr)
        summary.step = summary_of(*setup);
      summary.judge(plan.model.parameters.acceptance);
      write_summary(folder.path(), summary, log);
      throw StoppedRun(std::string(lost.what()) +
                         (picture.empty() ?
                            "" :
                            " The state before this stage and the "
                            "motion from there are in " +
                              folder.path() + "/" + picture + "."),
                       summary);
    }


    StaticState
    static_state_of(const RunPlan      &plan,
                    const RunSetup     *setup,
                    const ResultFolder &folder,
                    Log                &log)
    {
      const Model &model = plan.model;
      if (model.parameters.static_state.stage_names().empty())
        return StaticState(model);
      try
        {
          StaticState found = stored_or_found<StaticState>(
            model,
            folder,
            "rest.h5",
            read_static_state,
            [&] { return kept_or_found(model, folder, log); },
            [](const Model       &model,
               const StaticState &static_state,
               const std::string &file) {
              store_static_state(model, static_state, file);
            },
            log);
          warn_of(found.summary.value("warnings", std::vector<std::string>()),
                  log);
          return found;
        }
      catch (const LostEquilibrium &lost)
        {
          if (!folder.exists())
            throw;
          report_lost(
            lost, setup != nullptr ? setup->plan : plan, setup, folder, log);
        }
    }


    Modes
    modes_of(const Model        &model,
             const StaticState  &static_state,
             const ResultFolder &folder,
             Log                &log)
    {
      if (model.parameters.modes.number == 0)
        return {};
      Modes modes = stored_or_found<Modes>(
        model,
        folder,
        "modes.h5",
        read_modes,
        [&] { return find_modes(model, static_state, log); },
        store_modes,
        log);
      warn_of(modes.warnings, log);
      return modes;
    }
  } // namespace


  Simulation::Simulation(const Case       &parameters,
                         const RunOptions &options,
                         const MPI_Comm    communicator)
    : Simulation(after_linear_run(parameters, options, communicator),
                 parameters,
                 communicator)
  {}


  Simulation::Simulation(const RunOptions &options,
                         const Case       &parameters,
                         const MPI_Comm    communicator)
    : log(opened_log(parameters, options, communicator))
    , folder(parameters, options, log)
    , model(parameters, log)
    , plan(model, log)
    , early(early_setup(plan, folder, options, log))
    , found(options.validate ? StaticState(model) :
                               static_state_of(plan, early.get(), folder, log))
    , modes(options.validate ? Modes() : modes_of(model, found, folder, log))
    , setup(early ?
              std::move(early) :
              std::make_unique<RunSetup>(std::move(plan), modes, folder, log))
    , static_state(
        handed_over(std::move(found), model, setup->internal_force, log))
    , run(static_state, modes, folder, std::move(setup), log)
  {}


  Simulation::~Simulation() = default;
} // namespace Voussoir
