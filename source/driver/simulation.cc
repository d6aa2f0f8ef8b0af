#include <voussoir/base/version.h>
#include <voussoir/driver/simulation.h>
#include <voussoir/driver/stored_rest.h>

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


    /** Reads what the run that goes on from its checkpoint has stored, or else
     *  finds it. */
    template <typename Result>
    Result
    stored_or_found(const Model        &model,
                    const ResultFolder &folder,
                    const std::string  &name,
                    Result (*read)(const Model &, const std::string &),
                    Result (*find)(const Model &, Log &),
                    Log &log)
    {
      const std::string file = folder.checkpoints() + "/" + name;
      if (!folder.restarts() ||
          !damage_of_state(file, log.communicator()).empty())
        return find(model, log);
      log.line("Taken from ", file);
      return read(model, file);
    }
  } // namespace


  Simulation::Simulation(Case             &parameters,
                         const RunOptions &options,
                         const MPI_Comm    communicator)
    : log(opened_log(parameters, options, communicator))
    , folder(parameters, options, log)
    , model(parameters, log)
    , rest(
        options.validate ?
          RestState(model) :
          stored_or_found(model, folder, rest_file, read_rest, find_rest, log))
    , modes(options.validate ? Modes() :
                               stored_or_found(model,
                                               folder,
                                               modes_file,
                                               read_modes,
                                               find_modes,
                                               log))
    , run(model, rest, modes, folder, log)
  {}
} // namespace Voussoir
