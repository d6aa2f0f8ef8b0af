#ifndef voussoir_files_keyed_rows_h
#define voussoir_files_keyed_rows_h

#include <voussoir/base/keyed_values.h>

#include <deal.II/base/mpi.h>

#include <cstdint>
#include <vector>

namespace Voussoir
{
  /** Rows of numbers, each with its key, in any order over the ranks. */
  struct KeyedRows
  {
    explicit KeyedRows(const unsigned int width)
      : width(width)
    {}

    /** The rows of some values, without rows of zeros. */
    explicit KeyedRows(const KeyedValues &values);

    const double *
    row(const std::size_t i) const
    {
      return numbers.data() + i * width;
    }

    /** Checksum of the rows of all ranks, independent of their order. */
    std::uint64_t
    checksum(const MPI_Comm communicator) const;

    unsigned int               width;
    std::vector<std::uint64_t> keys;
    std::vector<double>        numbers;
  };

  /** Number of this rank's rows of some values that are not zero. */
  std::size_t
  n_kept_rows(const KeyedValues &values);

  /** Sends the rows from any ranks to the ranks that have their keys; numbers
   *  without a row become zero. */
  void
  distribute(const KeyedRows   &rows,
             const KeyedValues &values,
             const MPI_Comm     communicator);

  std::uint64_t
  byte_checksum(const std::vector<std::uint8_t> &bytes);
} // namespace Voussoir

#endif
