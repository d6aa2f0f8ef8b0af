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
   * Calls @p action and turns its exceptions into one sentence on the first
   * rank that has one and exit code 1, or for a stop on request the one for
   * that.
   */
  int
  guarded(const std::function<void()> &action, const MPI_Comm communicator);
} // namespace Voussoir

#endif
