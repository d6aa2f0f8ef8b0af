#ifndef voussoir_base_parallel_session_h
#define voussoir_base_parallel_session_h

#include <deal.II/base/mpi.h>

#include <filesystem>
#include <memory>

namespace Voussoir
{
  /**
   * Initialization and end of every program of the project: MPI with one thread
   * per rank, which the fused vector updates of the step need, and numbers
   * below 1e-308 flushed to zero, since such tails of decaying waves cost a
   * hundred times as much as others.
   */
  class ParallelSession
  {
  public:
    ParallelSession(int &argc, char **&argv);
    ~ParallelSession();

  private:
    /** Folder for the session files of Open MPI, of a run without mpirun. */
    std::filesystem::path                                     session_folder;
    std::unique_ptr<dealii::Utilities::MPI::MPI_InitFinalize> mpi;
  };
} // namespace Voussoir

#endif
