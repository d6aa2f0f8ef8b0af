#include <voussoir/base/machine.h>

#include <deal.II/base/utilities.h>

#include <fstream>

namespace Voussoir
{
  using namespace dealii;

  RanksOfMachine::RanksOfMachine(const MPI_Comm all)
    : all(all)
  {
    MPI_Comm_split_type(
      all, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &communicator);
  }


  RanksOfMachine::~RanksOfMachine()
  {
    MPI_Comm_free(&communicator);
  }


  unsigned int
  RanksOfMachine::n_machines() const
  {
    const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;
    return Utilities::MPI::sum(first ? 1U : 0U, all);
  }


  bool
  RanksOfMachine::is_group() const
  {
    const unsigned int size =
      Utilities::MPI::max(Utilities::MPI::n_mpi_processes(communicator), all);
    const bool fits = Utilities::MPI::this_mpi_process(all) % size ==
                      Utilities::MPI::this_mpi_process(communicator);
    return Utilities::MPI::min(fits ? 1 : 0, all) == 1;
  }


  std::vector<unsigned int>
  RanksOfMachine::numbers() const
  {
    return Utilities::MPI::all_gather(communicator,
                                      Utilities::MPI::this_mpi_process(all));
  }


  double
  largest_memory(const MPI_Comm communicator)
  {
    Utilities::System::MemoryStats memory{};
    // without this file the loop of deal.II that reads it has no end
    if (std::ifstream("/proc/self/status"))
      Utilities::System::get_memory_stats(memory);
    return Utilities::MPI::max(memory.VmHWM / 1024., communicator);
  }
} // namespace Voussoir
