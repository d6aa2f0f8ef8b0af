#include <voussoir/base/parallel_session.h>

#include <sys/prctl.h>

#include <csignal>
#include <cstdlib>

#if defined(__SSE__)
#  include <xmmintrin.h>
#endif

namespace Voussoir
{
  ParallelSession::ParallelSession(int &, char **&argv)
  {
#if defined(__SSE__)
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _mm_setcsr(_mm_getcsr() | 0x0040);
#endif
    // A file that grows beyond the limit of its size is an error like others.
    std::signal(SIGXFSZ, SIG_IGN);
    // Ranks do not outlive an mpirun that is killed: Open MPI lets them go on,
    // and write, for a second.
    if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr)
      prctl(PR_SET_PDEATHSIG, SIGKILL);
    // Shared file pointers are not used. Of Open MPI's components for them "sm"
    // keeps a file in the session's folder, which two programs without mpirun
    // at the same time take from each other, and "lockedfile" one beside each
    // file that is opened: on a full disk the first rank gives up and the
    // others wait for it.
    setenv("OMPI_MCA_sharedfp", "individual", 0);
    // Libraries get the program's name alone: PETSc would take arguments for
    // its options and complain that it does not use them.
    int just_the_name = 1;
    mpi =
      std::make_unique<dealii::Utilities::MPI::MPI_InitFinalize>(just_the_name,
                                                                 argv,
                                                                 1);
  }
} // namespace Voussoir
