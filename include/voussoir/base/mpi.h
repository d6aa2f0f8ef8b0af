#ifndef voussoir_base_mpi_h
#define voussoir_base_mpi_h

#include <deal.II/base/mpi.h>

#include <vector>

namespace Voussoir
{
  /** Entry by entry sums of equally long lists over the ranks. */
  template <typename Number>
  std::vector<Number>
  sum_over_ranks(const std::vector<Number> &values, const MPI_Comm communicator)
  {
    std::vector<Number> sums(values.size());
    dealii::Utilities::MPI::sum(values, communicator, sums);
    return sums;
  }

  /** The lists of all ranks, one after the other. */
  template <typename T>
  std::vector<T>
  join_over_ranks(const std::vector<T> &list, const MPI_Comm communicator)
  {
    std::vector<T> joined;
    for (const auto &part :
         dealii::Utilities::MPI::all_gather(communicator, list))
      joined.insert(joined.end(), part.begin(), part.end());
    return joined;
  }
} // namespace Voussoir

#endif
