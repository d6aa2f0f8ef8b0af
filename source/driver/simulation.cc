#include <voussoir/base/version.h>
#include <voussoir/driver/simulation.h>

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
      auto setup = std::make_unique<RunSetup>(model, Modes(), folder, log);
      check_modes(model);
      if (folder.wanted() && !options.validate)
        folder.claim(log);
      return setup;
    }


    /** The setup again, if it depends on the modes. */
    std::unique_ptr<RunSetup>
    adapted_setup(std::unique_ptr<RunSetup> setup,
                  const Modes              &modes,
                  const ResultFolder       &folder,
                  Log                      &log)
    {
      const Model &model = setup->model;
      if (model.parameters.damping.modes.empty() || modes.list.empty())
        return setup;
      return std::make_unique<RunSetup>(model, modes, folder, log);
    }
  } // namespace


  Simulation::Simulation(Case             &parameters,
                         const RunOptions &options,
                         const MPI_Comm    communicator)
    : log(opened_log(parameters, options, communicator))
    , folder(parameters, options, log)
    , model(parameters, log)
    , setup(checked_setup(model, folder, options, log))
    , rest(options.validate ? RestState(model) : find_rest(model, log))
    , modes(options.validate ? Modes() : find_modes(model, log))
    , run(rest,
          modes,
          folder,
          adapted_setup(std::move(setup), modes, folder, log),
          log)
  {}
} // namespace Voussoir
