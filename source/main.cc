#include <voussoir/driver/command_line.h>

#include <deal.II/base/mpi.h>

#if defined(__SSE__)
#  include <xmmintrin.h>
#endif

int
main(int argc, char **argv)
{
#if defined(__SSE__)
  // numbers below 1e-308, as the tails of decaying waves become, cost a hundred
  // times as much; flush them to zero
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
  _mm_setcsr(_mm_getcsr() | 0x0040);
#endif
  // one thread per rank: the fused vector updates of the step need it
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  return Voussoir::run_command_line(argc, argv, MPI_COMM_WORLD);
}
