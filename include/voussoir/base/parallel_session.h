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
   * below 1e-308 flushed to zero, since arithmetic with such numbers, as in the
   * tails of decaying waves, takes a hundred times as long.
   */
  class ParallelSession
  {
  public:
    ParallelSession(int &argc, char **&argv);
    ~ParallelSession();

  private:
    /** Folder of Open MPI's session files in a run without mpirun. */
    std::filesystem::path                                     session_folder;
    std::unique_ptr<dealii::Utilities::MPI::MPI_InitFinalize> mpi;
  };
} // namespace Voussoir

#endif
