#ifndef voussoir_driver_command_line_h
#define voussoir_driver_command_line_h

#include <deal.II/base/mpi.h>

#include <functional>

namespace Voussoir
{
  /** Runs `voussoir` with its arguments; returns the exit code. */
  int
  run_command_line(const int argc, char **argv, const MPI_Comm communicator);

  /**
   * Calls @p action. The first rank with an exception reports it in one
   * sentence, and the exit code is 1, or exit_code_stopped after a stop on
   * request.
   */
  int
  guarded(const std::function<void()> &action, const MPI_Comm communicator);
} // namespace Voussoir

#endif
