#ifndef voussoir_fem_single_nodes_h
#define voussoir_fem_single_nodes_h

#include <voussoir/fem/batch_nodes.h>

#include <array>

namespace Voussoir
{
  /**
   * Nodes of one or two batches of trilinear cells, whose values are read and
   * written in single precision: a cell gets the displacement of its nodes
   * relative to its first one, and this difference is formed in double
   * precision, so that round-off is relative to the strain and not to the
   * displacement. Forces are summed at the nodes in double precision.
   */
  class SingleNodes
  {
  public:
    using MatrixFree = Discretization::MatrixFree;

    explicit SingleNodes(const MatrixFree &matrix_free)
      : matrix_free(matrix_free)
      , by_batch(matrix_free)
      , corners(matrix_free.single_corners.lock())
    {}

    /** Component by component: component d of node v is entry 8 d + v. */
    using Values = std::array<Singles, 24>;

    /** The nodes of @p n batches from @p batch on; with one batch, both halves
     *  of the values are the same. */
    void
    reinit(const unsigned int batch, const unsigned int n);

    /** Corners of the cells relative to their first one [m]. */
    void
    read_corners(Values &values) const;

    void
    read(Values &values, const Vector &vector);

    /** The values of vector + factor other. */
    void
    read(Values       &values,
         const Vector &vector,
         const Vector &other,
         const double  factor);

    /** Adds the values of the first batch (@p half 0) or of the second one. */
    void
    add_half(Vector &vector, const Values &values, const unsigned int half);

    /** Adds the values of all batches. */
    void
    add_to(Vector &vector, const Values &values);

  private:
    using Half = std::array<Lanes, 24>;

    /** load(i) are the four entries of a vector that begin at i, load_half(i)
     *  the values of a batch. */
    template <typename Load, typename LoadHalf>
    void
    read_relative(Values &values, const Load &load, const LoadHalf &load_half);

    /** Values of a batch. */
    Half
    half_of(const Vector &vector, const unsigned int half);

    const MatrixFree                                      &matrix_free;
    BatchNodes                                             by_batch;
    const std::shared_ptr<const MatrixFree::SingleCorners> corners;
    unsigned int first_batch = 0, n_batches = 0;

    // MatrixFree::node_entries of the batches
    std::array<const unsigned int *, 2> entries{{nullptr, nullptr}};
  };
} // namespace Voussoir

#endif
