#ifndef voussoir_fem_point_history_h
#define voussoir_fem_point_history_h

#include <voussoir/base/keyed_values.h>
#include <voussoir/fem/discretization.h>

#include <deal.II/base/symmetric_tensor.h>

namespace Voussoir
{
  /** Strain or stress of one integration point in each SIMD lane. */
  template <typename Number>
  using SymmetricTensor3 = dealii::SymmetricTensor<2, 3, Number>;

  /**
   * What the integration points of the cells of one material remember: the
   * numbers of its law, which begin at zero, in SIMD lanes.
   */
  class PointHistory
  {
  public:
    /** One lane of a batch. */
    struct Place
    {
      unsigned int batch, lane;
    };

    /** @param width numbers of a point; 0 for a material without memory */
    PointHistory(const Discretization &discretization,
                 const unsigned int    material,
                 const unsigned int    width);

    /** Whether there is nothing to remember. */
    bool
    empty() const;

    /** The `width` numbers of point @p q of the cells of a batch. */
    Lanes *
    values(const unsigned int batch, const unsigned int q)
    {
      return numbers.data() + width * index(batch, q);
    }

    const Lanes *
    values(const unsigned int batch, const unsigned int q) const
    {
      return numbers.data() + width * index(batch, q);
    }

    /** Whether point @p q of any cell of the batch has left the elastic range.
     */
    bool
    is_active(const unsigned int batch, const unsigned int q) const
    {
      return active[index(batch, q)] != 0;
    }

    void
    activate(const unsigned int batch, const unsigned int q)
    {
      active[index(batch, q)] = 1;
    }

    /** Width of the band in which a crack lives: the edge of a cube of the
     *  cell's volume over the degree of the elements [m]. */
    const Lanes &
    element_length(const unsigned int batch) const
    {
      return lengths[slot_of_batch[batch]];
    }

    /**
     * Strain that the law sees beside that of the displacement, of the static
     * state and of temperature; see CellKernel::add_response.
     */
    const SymmetricTensor3<Lanes> &
    strain_offset(const unsigned int batch, const unsigned int q) const
    {
      return offsets[index(batch, q)];
    }

    SymmetricTensor3<Lanes> &
    strain_offset(const unsigned int batch, const unsigned int q)
    {
      return offsets[index(batch, q)];
    }

    /** Elastic strain of the static state, before which damping does not
     *  reach back. */
    const SymmetricTensor3<Lanes> &
    static_strain(const unsigned int batch, const unsigned int q) const
    {
      return static_strains[index(batch, q)];
    }

    SymmetricTensor3<Lanes> &
    static_strain(const unsigned int batch, const unsigned int q)
    {
      return static_strains[index(batch, q)];
    }

    bool has_offset = false;

    /** Gives every point a strain offset and a static strain of zero. */
    void
    make_offsets();

    /** Share of the stress of damping that damage has left. */
    Lanes &
    damping_share(const unsigned int batch, const unsigned int q)
    {
      return damping_shares[index(batch, q)];
    }

    const Lanes &
    damping_share(const unsigned int batch, const unsigned int q) const
    {
      return damping_shares[index(batch, q)];
    }

    /** Keeps the numbers of now as those of the static state. */
    void
    mark_start();

    /** Those of the static state; null: zeros. */
    const Lanes *
    values_at_start(const unsigned int batch, const unsigned int q) const;

    /** Cells of this material on this rank, with their places. */
    const std::vector<std::pair<Discretization::Cell, Place>> &
    cells() const;

    /** Place of a cell of this material. */
    Place
    place_of(const Discretization::Cell &cell) const;

    /** The numbers of one point of one cell. */
    std::vector<double>
    read(const Place &place, const unsigned int q) const;

    /** What a checkpoint must hold; `load` takes what has been read into these
     *  numbers. */
    KeyedValues
    checkpoint_values();

    void
    load();

    unsigned int width, n_points = 0;

    /** Energy lost to cracks and plastic flow since the start, this rank's [J].
     */
    double dissipated = 0.;

  private:
    std::size_t
    index(const unsigned int batch, const unsigned int q) const
    {
      return std::size_t(slot_of_batch[batch]) * n_points + q;
    }

    void
    exchange(const bool load);

    std::vector<unsigned int>                           slot_of_batch;
    std::vector<std::pair<Discretization::Cell, Place>> places;
    std::vector<unsigned int>                           item_of_cell;
    dealii::AlignedVector<Lanes> numbers, at_start, lengths, damping_shares;
    dealii::AlignedVector<SymmetricTensor3<Lanes>> offsets, static_strains;
    std::vector<char>                              active;
    std::vector<double>                            packed;
  };
} // namespace Voussoir

#endif
