#include <voussoir/base/parallel_session.h>
#include <voussoir/driver/command_line.h>

int
main(int argc, char **argv)
{
  const Voussoir::ParallelSession session(argc, argv);
  return Voussoir::run_command_line(argc, argv, MPI_COMM_WORLD);
}
