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
} // namespace Voussoir

#endif
