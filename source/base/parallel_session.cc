#include <voussoir/base/parallel_session.h>

#include <sys/prctl.h>

#include <csignal>
#include <cstdlib>

#if defined(__SSE__)
#  include <xmmintrin.h>
#endif

namespace Voussoir
{
  namespace
  {
    /**
     * Without mpirun, Open MPI 4 starts a daemon for each program, in a folder
     * that all programs of a user share and that each removes at its end: one
     * that starts at that moment fails (orte/util/session_dir.c). A folder of
     * its own, and no daemon, which takes half of the start. Empty where
     * mpirun or Slurm starts the ranks, where the user has named a folder, and
     * where none can be made.
     */
    std::filesystem::path
    own_session_folder()
    {
      for (const char *set_by_others : {"OMPI_COMM_WORLD_SIZE",
                                        "PMIX_NAMESPACE",
                                        "OMPI_MCA_orte_tmpdir_base"})
        if (std::getenv(set_by_others) != nullptr)
          return {};
      std::error_code error;
      std::string     name =
        std::filesystem::temp_directory_path(error) / "voussoir-XXXXXX";
      if (error || mkdtemp(name.data()) == nullptr)
        return {};
      setenv("OMPI_MCA_orte_tmpdir_base", name.c_str(), 1);
      setenv("OMPI_MCA_ess_singleton_isolated", "1", 1);
      return name;
    }
  } // namespace

  ParallelSession::ParallelSession(int &, char **&argv)
  {
#if defined(__SSE__)
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _mm_setcsr(_mm_getcsr() | 0x0040);
#endif
    // Exceeding the limit of file size is an error of the write, not a signal.
    std::signal(SIGXFSZ, SIG_IGN);
    // Ranks do not outlive an mpirun that is killed: Open MPI lets them
    // continue, and write, for a second.
    if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr)
      prctl(PR_SET_PDEATHSIG, SIGKILL);
    // Shared file pointers are not used. Of Open MPI's components for them "sm"
    // keeps a file in the session's folder, which two programs without mpirun
    // remove from each other, and "lockedfile" one beside each file that is
    // opened: on a full disk the first rank gives up and the others wait for
    // it.
    setenv("OMPI_MCA_sharedfp", "individual", 0);
    session_folder = own_session_folder();
    // Libraries get the program's name alone: PETSc would take arguments for
    // its options and complain that it does not use them.
    int just_the_name = 1;
    mpi =
      std::make_unique<dealii::Utilities::MPI::MPI_InitFinalize>(just_the_name,
                                                                 argv,
                                                                 1);
    // runs that this program starts have folders of their own
    if (!session_folder.empty())
      for (const char *ours :
           {"OMPI_MCA_orte_tmpdir_base", "OMPI_MCA_ess_singleton_isolated"})
        unsetenv(ours);
  }

  ParallelSession::~ParallelSession()
  {
    mpi.reset();
    std::error_code ignored;
    if (!session_folder.empty())
      std::filesystem::remove_all(session_folder, ignored);
  }
} // namespace Voussoir
