#ifndef voussoir_analysis_block_h
#define voussoir_analysis_block_h

#include <voussoir/fem/simd.h>

#include <deal.II/base/aligned_vector.h>
#include <deal.II/lac/full_matrix.h>

#include <mpi.h>

#include <vector>

namespace Voussoir
{
  /** Vectors of the same length, of which each rank has some entries. */
  class Block
  {
  public:
    /** Zeros. @param size entries of this rank */
    Block(const std::size_t size, const unsigned int n_vectors);

    double *
    operator[](const unsigned int vector)
    {
      return values.data() + vector * stride;
    }

    const double *
    operator[](const unsigned int vector) const
    {
      return values.data() + vector * stride;
    }

    /** Entries of this rank, padded with zeros to whole registers. */
    std::size_t
    padded_size() const
    {
      return stride;
    }

  private:
    std::size_t                   stride;
    dealii::AlignedVector<double> values;
  };

  /** Vectors of some blocks, all of the same size. */
  using Columns = std::vector<double *>;

  /** All products a_i . b_j = a_j . b_i, summed over the ranks. */
  dealii::FullMatrix<double>
  symmetric_products(const Columns    &a,
                     const Columns    &b,
                     const std::size_t padded_size,
                     const MPI_Comm    communicator);

  /** Each target j becomes the sum of c_ij times column i; targets may be
   *  among the columns. */
  void
  combine(const Columns                    &targets,
          const Columns                    &columns,
          const dealii::FullMatrix<double> &c,
          const std::size_t                 padded_size);
} // namespace Voussoir

#endif
