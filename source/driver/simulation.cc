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
  } // namespace


  Simulation::Simulation(Case             &parameters,
                         const RunOptions &options,
                         const MPI_Comm    communicator)
    : log(opened_log(parameters, options, communicator))
    , folder(parameters, options, log)
    , model(parameters, log)
    , rest(options.validate ? RestState(model) : find_rest(model, log))
    , modes(options.validate ? Modes() : find_modes(model, log))
    , run(model, rest, modes, folder, log)
  {}
} // namespace Voussoir
