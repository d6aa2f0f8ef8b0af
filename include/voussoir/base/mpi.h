#ifndef voussoir_base_mpi_h
#define voussoir_base_mpi_h

#include <deal.II/base/mpi.h>

#include <numeric>
#include <type_traits>
#include <vector>

namespace Voussoir
{
  /** Sums of equally long lists over the ranks, entry by entry. */
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
    namespace MPI = dealii::Utilities::MPI;
    std::vector<T> joined;
    if constexpr (std::is_trivially_copyable_v<T>)
      {
        // not by deal.II's all_gather, which would compress the lists
        const auto sizes =
          MPI::all_gather(communicator, static_cast<int>(list.size()));
        std::vector<int> begins(sizes.size(), 0);
        std::partial_sum(sizes.begin(), sizes.end() - 1, begins.begin() + 1);
        joined.resize(begins.back() + sizes.back());
        MPI_Datatype type;
        MPI_Type_contiguous(sizeof(T), MPI_BYTE, &type);
        MPI_Type_commit(&type);
        MPI_Allgatherv(list.data(),
                       list.size(),
                       type,
                       joined.data(),
                       sizes.data(),
                       begins.data(),
                       type,
                       communicator);
        MPI_Type_free(&type);
      }
    else
      for (const auto &part : MPI::all_gather(communicator, list))
        joined.insert(joined.end(), part.begin(), part.end());
    return joined;
  }
} // namespace Voussoir

#endif
