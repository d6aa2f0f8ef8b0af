#include <voussoir/base/parallel_session.h>

#include <sys/prctl.h>

#include <csignal>
#include <cstdlib>
#include <optional>
#include <string>

#if defined(__SSE__)
#  include <xmmintrin.h>
#endif

namespace Voussoir
{
  namespace
  {
    /**
     * Without mpirun, Open MPI keeps its files in a folder that all programs of
     * a user share and that each removes at its end: a program that starts at
     * that moment fails (Open MPI 4: orte/util/session_dir.c; 5:
     * ompi/runtime/ompi_rte.c). So each program gets a folder of its own. Empty
     * where mpirun or Slurm starts the ranks, where the user has named a
     * folder, and where none can be made.
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
      return name;
    }

    /** Sets a variable of the environment, and resets it when destroyed. */
    class TemporarySetting
    {
    public:
      TemporarySetting(const char *name, const std::string &value)
        : name(name)
      {
        if (const char *const before = std::getenv(name))
          value_before = before;
        setenv(name, value.c_str(), 1);
      }

      ~TemporarySetting()
      {
        if (value_before)
          setenv(name, value_before->c_str(), 1);
        else
          unsetenv(name);
      }

      TemporarySetting(const TemporarySetting &) = delete;

    private:
      const char                *name;
      std::optional<std::string> value_before;
    };
  } // namespace

  ParallelSession::ParallelSession(int &, char **&argv)
  {
#if defined(__SSE__)
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _mm_setcsr(_mm_getcsr() | 0x0040);
#endif
    // Exceeding the limit of file size is an error of the write, not a signal.
    std::signal(SIGXFSZ, SIG_IGN);
    // Ranks end with an mpirun that is killed; Open MPI would let them
    // continue, and write, for a second.
    if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr)
      prctl(PR_SET_PDEATHSIG, SIGKILL);
    // Shared file pointers are not used. Of the components of Open MPI for
    // them, "sm" keeps a file in the session's folder, which two programs
    // without mpirun remove from each other, and "lockedfile" keeps a file
    // beside each open file: on a full disk the first rank gives up and the
    // others wait for it.
    setenv("OMPI_MCA_sharedfp", "individual", 0);
    session_folder = own_session_folder();
    std::optional<TemporarySetting> folder, without_daemon;
    if (!session_folder.empty())
      {
        folder.emplace("TMPDIR", session_folder.string());
        // the daemon of Open MPI 4 takes half of the time of a start
        without_daemon.emplace("OMPI_MCA_ess_singleton_isolated", "1");
      }
    // Libraries get the program's name alone: PETSc would read the arguments as
    // its own options and warn that they are unused.
    int just_the_name = 1;
    mpi =
      std::make_unique<dealii::Utilities::MPI::MPI_InitFinalize>(just_the_name,
                                                                 argv,
                                                                 1);
  }

  ParallelSession::~ParallelSession()
  {
    mpi.reset();
    std::error_code ignored;
    if (!session_folder.empty())
      std::filesystem::remove_all(session_folder, ignored);
  }
} // namespace Voussoir
