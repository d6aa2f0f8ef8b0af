#ifndef voussoir_fem_point_history_h
#define voussoir_fem_point_history_h

#include <voussoir/base/keyed_values.h>
#include <voussoir/base/sum.h>
#include <voussoir/fem/crack_bands.h>
#include <voussoir/fem/discretization.h>
#include <voussoir/fem/stabilised_fields.h>

#include <memory>

namespace Voussoir
{
  /**
   * State of an integration point that has left the elastic range, beside the
   * internal variables of its law: its crack, and its last step, to which the
   * energy of the next step refers. See DampedResponse.
   */
  struct ActivePoint
  {
    Lanes band = 0.;                    // width of the crack band [m]; 0: none
    dealii::Tensor<1, 3, Lanes> normal; // across the crack

    SymmetricTensor3<Lanes> strain;      // B u [1]
    SymmetricTensor3<Lanes> law_strain;  // passed to the law, e [1]
    SymmetricTensor3<Lanes> plastic;     // e_p [1]
    SymmetricTensor3<Lanes> stress;      // of the law [Pa]
    SymmetricTensor3<Lanes> filter;      // B w [1]
    Lanes                   share  = 1.; // r [1]
    Lanes                   impact = 0.; // across a crack that closes [Pa]
    Lanes                   filter_imbalance = 0.; // of its branches [J/m3]

    /** The stress of the equation of motion [Pa]. */
    SymmetricTensor3<Lanes>
    total_stress() const
    {
      return stress +
             impact * dealii::symmetrize(dealii::outer_product(normal, normal));
    }

    /** Resets the lanes of elastic points to their initial state. */
    void
    forget_elastic();
  };


  /** What CrackTips and CrackPlanes know of the cells of a batch. */
  struct TipsOfBatch
  {
    Lanes strength = 1.; // over that of the material
    Lanes run_on   = 0.; // 1 where the crack of the cell has been seen
  };


  /** Planes of the cracks that the cells of a batch have or are about to have;
   *  see CrackPlanes. */
  struct PlanesOfBatch
  {
    Lanes width = 0.; // of the crack band [m]; 0: the cell has no plane

    dealii::Tensor<1, 3, Lanes> point, normal; // of the plane
    dealii::Tensor<1, 3, Lanes> parent;  // normal of the crack that runs in
    dealii::Tensor<1, 3, Lanes> opening; // normal in the law; zero: its own

    Lanes released = 0.; // share of the stabilisation
    Lanes closed   = 0.; // 1 where the released share acts again
    StabilisedFields<Lanes> at_closing = {}; // strain from which on it acts

    /** Calls visit(number) for each number. */
    template <typename Visitor>
    void
    for_each_number(const Visitor &visit)
    {
      visit(width);
      for (dealii::Tensor<1, 3, Lanes> *vector :
           {&point, &normal, &parent, &opening})
        for (unsigned int d = 0; d < 3; ++d)
          visit((*vector)[d]);
      visit(released);
      visit(closed);
      at_closing.for_each_number(visit);
    }
  };


  /** Energy that has been lost at the points since the start, of this rank [J]:
   *  by the law in cracks and plastic flow, by closing cracks, and the work on
   *  damping at points beyond the elastic range, of which a part is stored.
   */
  struct PointLosses
  {
    PointLosses() = default;

    explicit PointLosses(const bool exact)
      : material(exact)
      , closing(exact)
      , damping(exact)
    {}

    Sum material, closing, damping;

    PointLosses &
    operator+=(const PointLosses &other)
    {
      material += other.material;
      closing += other.closing;
      damping += other.damping;
      return *this;
    }
  };


  /**
   * The internal variables of the integration points of the cells of one
   * material, which begin at zero, in SIMD lanes. Copies share the data that no
   * step changes: the places of the points and their static strains.
   */
  class PointHistory
  {
  public:
    using Place = Discretization::Place;

    /** @param width internal variables of a point; 0 for a linear law */
    PointHistory(const Discretization &discretization,
                 const unsigned int    material,
                 const unsigned int    width);

    /** Whether there are no internal variables. */
    bool
    empty() const
    {
      return n_numbers == 0;
    }

    /** Whether the result of a cell must not depend on the other cells of its
     *  batch, down to round-off. */
    bool
    lanes_are_alone() const
    {
      return points->lanes_are_alone;
    }

    /** Points of a cell. */
    unsigned int
    n_points() const
    {
      return points->per_cell;
    }

    /** Internal variables of point @p q of the cells of a batch. They are zero
     *  at an elastic point; if they are changed, the point must be activated.
     */
    Lanes *
    values(const unsigned int batch, const unsigned int q)
    {
      return numbers.data() + n_numbers * active[index(batch, q)];
    }

    const Lanes *
    values(const unsigned int batch, const unsigned int q) const
    {
      return numbers.data() + n_numbers * active[index(batch, q)];
    }

    /** Whether point @p q of any cell of the batch has left the elastic range.
     */
    bool
    is_active(const unsigned int batch, const unsigned int q) const
    {
      return active[index(batch, q)] != 0;
    }

    /** State of such a point. */
    ActivePoint &
    active_point(const unsigned int batch, const unsigned int q)
    {
      return active_points[active[index(batch, q)] - 1];
    }

    const ActivePoint &
    active_point(const unsigned int batch, const unsigned int q) const
    {
      return active_points[active[index(batch, q)] - 1];
    }

    /** Marks a point as beyond the elastic range, with its present internal
     *  variables. */
    void
    activate(const unsigned int batch,
             const unsigned int q,
             const ActivePoint &point);

    /** Shape of the cells of a batch. */
    const CrackBands &
    bands(const unsigned int batch) const
    {
      return points->bands[points->slot_of_batch[batch]];
    }

    /** Tensile strength of the cells of a batch over that of their material. */
    Lanes
    tip_strength(const unsigned int batch) const
    {
      return tips.empty() ? Lanes(1.) :
                            tips[points->slot_of_batch[batch]].strength;
    }

    TipsOfBatch &
    tips_of(const unsigned int batch)
    {
      if (tips.empty())
        tips.resize(points->bands.size());
      return tips[points->slot_of_batch[batch]];
    }

    /** Takes over tips and planes of cracks from another history of the same
     *  points. */
    void
    take_tips(const PointHistory &other)
    {
      tips   = other.tips;
      planes = other.planes;
    }

    /** Lets cracks have planes; for cells with one point. */
    void
    make_planes();

    bool
    has_planes() const
    {
      return with_planes;
    }

    PlanesOfBatch &
    planes_of(const unsigned int batch)
    {
      return planes[points->slot_of_batch[batch]];
    }

    const PlanesOfBatch &
    planes_of(const unsigned int batch) const
    {
      return planes[points->slot_of_batch[batch]];
    }

    /** Stabilised strains of the static state: of its displacement, and the
     *  elastic one times the static factor; and the share of the stabilisation
     *  that cracks had released there. */
    struct StabilisedStatic
    {
      StabilisedFields<Lanes> strain = {}, elastic = {};
      Lanes                   released = 0.;
    };

    /** Of cells whose cracks have planes, after a static state. */
    const StabilisedStatic &
    stabilised_static(const unsigned int batch) const
    {
      return static_strains->stabilised[points->slot_of_batch[batch]];
    }

    StabilisedStatic &
    stabilised_static(const unsigned int batch)
    {
      return static_strains->stabilised[points->slot_of_batch[batch]];
    }

    /** Share of the released stabilisation of a batch that cracks have released
     *  since the static state, in which it had the stress of that state. */
    Lanes
    released_since_static_state(const unsigned int batch) const
    {
      const Lanes now = planes_of(batch).released, zero = 0.,
                  at_rest = stabilised_static(batch).released;
      return dealii::compare_and_apply_mask<
        dealii::SIMDComparison::less_than_or_equal>(now,
                                                    at_rest,
                                                    zero,
                                                    (now - at_rest) / now);
    }

    /** Begins a run with the stabilisation that the cracks of the static state
     *  have released, in the moduli of the run. */
    void
    take_over_released(const unsigned int batch);

    /** Strain offset e_0, which is added to the strain of the displacement in
     *  the law; see DampedResponse. */
    const SymmetricTensor3<Lanes> &
    strain_offset(const unsigned int batch, const unsigned int q) const
    {
      return static_strains->offsets[index(batch, q)];
    }

    SymmetricTensor3<Lanes> &
    strain_offset(const unsigned int batch, const unsigned int q)
    {
      return static_strains->offsets[index(batch, q)];
    }

    /** Elastic strain e_s of the static state, on which damping does not act.
     */
    const SymmetricTensor3<Lanes> &
    static_strain(const unsigned int batch, const unsigned int q) const
    {
      return static_strains->elastic[index(batch, q)];
    }

    SymmetricTensor3<Lanes> &
    static_strain(const unsigned int batch, const unsigned int q)
    {
      return static_strains->elastic[index(batch, q)];
    }

    /** Whether there has been a static state; without one, e_0 and e_s are
     *  zero. */
    bool
    has_static_strains() const
    {
      return static_strains != nullptr;
    }

    /** Sets e_0 and e_s to zero, in this history and not in its copies. */
    void
    make_static_strains();

    /** Cells of this material on this rank, with their places. */
    const std::vector<std::pair<Discretization::Cell, Place>> &
    cells() const;

    /** Imbalance of the Maxwell branches [J/m3], see DampedResponse, which the
     *  energy balance stores; zero before the first balance. */
    Lanes &
    imbalance(const unsigned int batch, const unsigned int q)
    {
      if (imbalances.empty())
        imbalances.resize(active.size());
      return imbalances[index(batch, q)];
    }

    Lanes
    imbalance(const unsigned int batch, const unsigned int q) const
    {
      return imbalances.empty() ? Lanes(0.) : imbalances[index(batch, q)];
    }

    /** Width of the crack band of one point of one cell [m]; zero if it is
     *  elastic. */
    double
    band(const Place &place, const unsigned int q) const
    {
      return is_active(place.batch, q) ?
               active_point(place.batch, q).band[place.lane] :
               0.;
    }

    /** Total stress of one point of one cell at its last step [Pa], if it has
     *  left the elastic range. */
    dealii::SymmetricTensor<2, 3>
    stress(const Place &place, const unsigned int q) const;

    /** Strain e passed to the law at such a point [1], less the elastic strain
     *  C^-1 : sigma of its stress. */
    dealii::SymmetricTensor<2, 3>
    inelastic_strain(const Place       &place,
                     const unsigned int q,
                     const double       young_modulus,
                     const double       poisson_ratio) const;

    /** Internal variables of one point of one cell. */
    std::vector<double>
    read(const Place &place, const unsigned int q) const;

    /** State for a checkpoint, a row for each cell. */
    KeyedValues
    checkpoint_values();

    /** Losses since the start. */
    PointLosses losses;

  private:
    /** Where the points are. */
    struct Points
    {
      bool                                                lanes_are_alone;
      unsigned int                                        per_cell = 0;
      std::vector<unsigned int>                           slot_of_batch;
      std::vector<std::pair<Discretization::Cell, Place>> cells;
      dealii::AlignedVector<CrackBands>                   bands; // by slot
    };

    /** Strains of the static state at the points. */
    struct StaticStrains
    {
      dealii::AlignedVector<SymmetricTensor3<Lanes>> offsets, elastic;
      dealii::AlignedVector<StabilisedStatic>        stabilised; // by slot
    };

    std::size_t
    index(const unsigned int batch, const unsigned int q) const
    {
      return std::size_t(points->slot_of_batch[batch]) * points->per_cell + q;
    }

    void
    pack(const Place &place, double *row);

    void
    unpack(const Place &place, const double *row);

    unsigned int                   n_numbers; // of a point
    std::shared_ptr<const Points>  points;
    std::shared_ptr<StaticStrains> static_strains;
    dealii::AlignedVector<Lanes>
      numbers; // of elastic points, then of the others
    dealii::AlignedVector<Lanes>         imbalances;
    dealii::AlignedVector<TipsOfBatch>   tips;   // by slot; none: as they begin
    dealii::AlignedVector<PlanesOfBatch> planes; // by slot, or none
    bool                                 with_planes = false;

    // place among the points beyond the elastic range, from one; 0: elastic
    std::vector<unsigned int>          active;
    dealii::AlignedVector<ActivePoint> active_points;
  };


  /**
   * The internal variables of all materials of a case. If it is empty the
   * materials are elastic.
   */
  class MaterialMemory
  {
  public:
    MaterialMemory() = default;

    /** @param widths internal variables of a point of each material, zero at
     *  first
     */
    MaterialMemory(const Discretization            &discretization,
                   const std::vector<unsigned int> &widths);

    /** Internal variables of a material; null if it has none. */
    PointHistory *
    of(const unsigned int material);

    const PointHistory *
    of(const unsigned int material) const;

    /** Takes over tips and planes of cracks from another state of the same
     *  case. */
    void
    take_tips(const MaterialMemory &other);

    /** Whether no material has internal variables. */
    bool
    empty() const;

    /** Energy lost so far. */
    PointLosses
    losses() const;

    /** Sets the energy lost so far. */
    void
    set_losses(const PointLosses &losses);

  private:
    std::vector<PointHistory> histories; // of each material
  };
} // namespace Voussoir

#endif
