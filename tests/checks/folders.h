#ifndef voussoir_tests_folders_h
#define voussoir_tests_folders_h

#include <deal.II/base/mpi.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace Voussoir
{
  /** Runs an action on files on the first rank, while the others wait. */
  inline void
  on_first(const MPI_Comm communicator, const std::function<void()> &action)
  {
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      action();
    MPI_Barrier(communicator);
  }


  /** Removes the files of an earlier run of the test in these folders. */
  inline void
  remove_folders(const std::vector<std::string> &folders,
                 const MPI_Comm                  communicator)
  {
    on_first(communicator, [&folders] {
      for (const std::string &folder : folders)
        std::filesystem::remove_all(folder);
    });
  }
} // namespace Voussoir

#endif
