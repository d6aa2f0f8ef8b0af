#ifndef voussoir_base_machine_h
#define voussoir_base_machine_h

#include <deal.II/base/mpi.h>

#include <vector>

namespace Voussoir
{
  /** The ranks that share the machine, and so the memory, of this rank. All
   *  ranks must make it, and call its functions, together. */
  class RanksOfMachine
  {
  public:
    explicit RanksOfMachine(const MPI_Comm all);

    ~RanksOfMachine();

    RanksOfMachine(const RanksOfMachine &) = delete;

    /** Number of machines that all the ranks run on. */
    unsigned int
    n_machines() const;

    /** Whether the machines have equally many ranks, one machine after the
     *  other. */
    bool
    is_group() const;

    /** The number among all ranks of each rank of the machine. */
    std::vector<unsigned int>
    numbers() const;

    const MPI_Comm all;
    MPI_Comm       communicator; // of the machine's ranks
  };


  /** Largest memory that one of the ranks has taken so far [MB]; 0 where the
   *  system does not tell (no /proc). All ranks must call it together. */
  double
  largest_memory(const MPI_Comm communicator);
} // namespace Voussoir

#endif
