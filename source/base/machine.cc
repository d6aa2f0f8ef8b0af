#include <voussoir/base/machine.h>

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
} // namespace Voussoir
