#ifndef voussoir_base_reproducible_sum_h
#define voussoir_base_reproducible_sum_h

#include <deal.II/base/mpi.h>

#include <vector>

namespace Voussoir
{
  /**
   * Sum of the terms of all ranks that depends, to the last bit, neither on
   * their order nor on the ranks. Its error is 2^-60 of the largest term for
   * each term: the digits are summed in three groups without rounding (Demmel
   * and Nguyen 2013). Holds for up to 2^33 terms.
   */
  double
  reproducible_sum(const std::vector<double> &terms,
                   const MPI_Comm             communicator);
} // namespace Voussoir

#endif
