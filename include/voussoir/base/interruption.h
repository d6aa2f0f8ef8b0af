#ifndef voussoir_base_interruption_h
#define voussoir_base_interruption_h

#include <deal.II/base/mpi.h>

#include <stdexcept>
#include <string>

namespace Voussoir
{
  /** Exit code of a run that was stopped on request and can continue:
   *  EX_TEMPFAIL of sysexits.h, for scripts that start such a run again. */
  constexpr int exit_code_stopped = 75;

  /** The program ends on request, which is no error. */
  class Stopped : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /**
   * From now on signals are requests and do not end the program: SIGUSR1 for a
   * checkpoint; SIGINT, SIGTERM, SIGHUP, SIGXCPU and SIGUSR2 for a checkpoint
   * and the end. A second SIGINT ends it at once. A SIGHUP that was ignored, as
   * under nohup, stays ignored.
   */
  void
  listen_to_signals();

  /** Whether this rank has been asked to stop since the last `stop`. */
  bool
  stop_requested();

  /** Whether this rank has been asked for a checkpoint since the last call. */
  bool
  take_checkpoint_request();

  /** Throws Stopped. */
  [[noreturn]] void
  stop(const std::string &sentence);

  /** Stops if any rank has been asked to stop. For set-up and static stages,
   *  from which no run can continue. Called on all ranks. */
  void
  stop_if_requested(const MPI_Comm communicator);
} // namespace Voussoir

#endif
