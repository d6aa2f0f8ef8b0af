#ifndef voussoir_fem_cell_kernel_h
#define voussoir_fem_cell_kernel_h

#include <voussoir/fem/leap_frog.h>
#include <voussoir/fem/point_history.h>
#include <voussoir/fem/rounding.h>

#include <limits>

namespace Voussoir
{
  /** A run of cell batches, [begin, end), that are all of one material. */
  struct CellRange
  {
    const Discretization::MatrixFree &matrix_free;
    unsigned int                      begin, end;
    bool                              one_point;          // of integration
    double                            stress_factor;      // k of this stage [1]
    bool                              exact_sums = false; // of energies
    Rounding *rounding         = nullptr; // of forces; null: none
    bool      single_precision = false;   // of forces, where it can be
  };

  /** A time step, as passed to laws with internal variables. */
  struct PointStep
  {
    // [s]; by default laws have no viscosity
    double length              = std::numeric_limits<double>::max();
    double closing_viscosity   = 0.; // c of DampedResponse [s]
    double branches            = 0.; // sum of the D_i of Maxwell damping [1]
    double relaxation          = 1.; // of the energy of the slowest branch [1]
    const MaxwellStep *maxwell = nullptr; // of these branches
  };


  /** Bounds of the forces K_e u_e of cells under a stable time step, from K_e
   *  <= K <= 4 M / dt^2 . */
  struct MotionBound
  {
    /** Vectors with factors [m]. The sum of their largest entries bounds every
     *  entry of the displacement and, with s = 1, of x + s w of SweepInput. */
    std::vector<std::pair<const Vector *, double>> parts;

    const Vector &mass;      // M [kg]
    double        time_step; // dt [s]
  };


  /**
   * Input of a sweep over the cells. With the damping memory w (filters of the
   * displacement u), the strain of elastic points is B (x + s w) , where x is u
   * plus the part of damping that is the same in all materials. A law with
   * internal variables needs B u as well: damping does not act in cracks.
   */
  struct SweepInput
  {
    /** How damping memory enters the strain. */
    enum class Damping
    {
      none,       // not at all: x is u
      common,     // within x, with the factor s of all materials
      by_material // by w, with the factor s of each material
    };

    const Vector      &displacement; // u [m]
    const Vector      &filtered;     // x [m]
    Damping            damping;
    const Vector      *damping_memory = nullptr; // w [m], if `by_material`
    PointStep          step           = {}; // of laws with internal variables
    const MotionBound *bound          = nullptr; // null: none is known
    bool single_precision = false; // of forces, where cells are trilinear

    /** Input without damping: laws get the strain of the displacement alone. */
    static SweepInput
    undamped(const Vector &displacement)
    {
      return {displacement, displacement, Damping::none};
    }
  };


  /**
   * Data for the energy of a damped motion, after the step from the velocity v-
   * to v+ : the displacement u since the static state, and the damping memory w
   * during the step.
   */
  struct DampedMotion
  {
    const Vector              &displacement;    // [m]
    const Vector              &velocity;        // v+ [m/s]
    const Vector              &velocity_before; // v- [m/s]
    const std::vector<Vector> &memory;          // w_i of the branches [m]
    const Damping             &damping;
    const double               time_step; // dt [s]
  };


  /** Data for the energy of points that have left the elastic range.
   */
  struct InelasticMotion
  {
    const Vector       &displacement;        // u [m]
    bool                has_static_state;    // before the motion
    const Vector       &static_displacement; // u_s [m], if any
    const PointHistory *static_history;      // of that state; null: elastic
    double              branches; // sum of the D_i of Maxwell damping [1]
  };


  /**
   * Energy of the elastic points, half a step before the displacement [J]. With
   * w_i+ = a w_i + b v+ the step does on branch i the work
   *   dt s w_i^T K (v- + v+)/2 ,
   * of which, with the energy E_i = dt s w_i^T K w_i+ / (2 b) of its spring,
   * the branch dissipates exactly
   *   dt s (1 - a) w_i^T K (w_i + w_i-) / (2 b) .
   */
  struct ElasticEnergy
  {
    ElasticEnergy() = default;

    explicit ElasticEnergy(const bool exact)
      : strain(exact)
      , memory(exact)
      , next_loss(exact)
      , last_loss(exact)
    {}

    Sum strain;    // u^T K (u - dt v+) / 2
    Sum memory;    // in the springs of the branches
    Sum next_loss; // of the branches in the next step
    Sum last_loss; // by viscosity in the last step

    ElasticEnergy &
    operator+=(const ElasticEnergy &other)
    {
      strain += other.strain;
      memory += other.memory;
      next_loss += other.next_loss;
      last_loss += other.last_loss;
      return *this;
    }
  };


  /** Stress and its tensile part [Pa]. */
  struct SplitStress
  {
    SymmetricTensor3<Lanes> all, tensile;
  };


  /** Energy of the points that have left the elastic range [J]. */
  struct InelasticEnergy
  {
    InelasticEnergy() = default;

    explicit InelasticEnergy(const bool exact)
      : stored(exact)
      , damping(exact)
    {}

    Sum stored;  // half a step before the displacement
    Sum damping; // stored part of the work on damping

    InelasticEnergy &
    operator+=(const InelasticEnergy &other)
    {
      stored += other.stored;
      damping += other.damping;
      return *this;
    }
  };

  /**
   * The operations of a material on a run of cell batches: the only virtual
   * calls of the cell loop. All vectors that are read must have their ghost
   * values.
   */
  class CellKernel
  {
  public:
    virtual ~CellKernel() = default;

    /**
     * Adds the elastic force to @p force [N],
     *   f = sum B^T k D : B (x + s w) ,
     * with the symbols of SweepInput.
     */
    virtual void
    add_force(const CellRange  &cells,
              const SweepInput &input,
              Vector           &force) const = 0;

    /** Internal variables of each integration point; 0 for a linear law. */
    virtual unsigned int
    n_history() const = 0;

    /**
     * As add_force, but with the stress of the law with internal variables,
     * which advance by one step; see DampedResponse. For an elastic law the two
     * agree.
     */
    virtual void
    add_response(const CellRange  &cells,
                 const SweepInput &input,
                 Vector           &force,
                 PointHistory     &history) const = 0;

    /** Sets the strain offset of the history in the static state, e_0 = - alpha
     *  T I, for the temperature T [K] of each node. */
    virtual void
    set_thermal_strain(const CellRange &cells,
                       PointHistory    &history,
                       const Vector    &temperature) const = 0;

    /** Takes over the points beyond the elastic range from the material of the
     *  static state; see LawDefaults::hand_over. */
    virtual void
    hand_over(const CellRange &cells, PointHistory &history) const = 0;

    /**
     * Sets the strain offset e_0 and the elastic strain e_s of the history for
     * the static displacement u_s [m] and the temperature T [K] of each node.
     * With e_0 the strain of an elastic point is a (B u_s - alpha T I), with
     * the static factor a of the material; that of any other point is the
     * strain of `hand_over`. See DampedResponse.
     */
    virtual void
    set_static_state(const CellRange &cells,
                     PointHistory    &history,
                     const Vector    &displacement,
                     const Vector    &temperature) const = 0;

    /** Energy of the elastic points of @p history, which stores their
     *  imbalance; null: all points are elastic. */
    virtual ElasticEnergy
    elastic_energy(const CellRange    &cells,
                   const DampedMotion &motion,
                   PointHistory       *history) const = 0;

    /**
     * Energy that the stabilisation of each cell of a batch stores, half a step
     * before the displacement, less the work of the forces of the static state
     * [J]. For cells with one point whose cracks have planes.
     *
     * @param motion with the displacement u, not that since the static state
     */
    virtual Lanes
    stabilisation_energy(const CellRange    &batch,
                         const DampedMotion &motion,
                         const PointHistory &history) const = 0;

    /** Elastic stress of the mean strain of each cell of a batch of trilinear
     *  cells, in cracked cells with the strain of their openings.
     *
     * @param history with the strain of the static state; null: none */
    virtual SplitStress
    elastic_stress(const CellRange    &batch,
                   const Vector       &displacement,
                   const PointHistory *history) const = 0;

    /**
     * Energy since the static state of the points that have left the elastic
     * range, less the work of the forces of that state.
     */
    virtual InelasticEnergy
    inelastic_energy(const CellRange       &cells,
                     const InelasticMotion &motion,
                     const PointHistory    &history) const = 0;

    /**
     * Adds the force that suppresses a free expansion [N],
     *   f = sum B^T k D : alpha T I ,
     * with the temperature T [K] of each node in all three components.
     */
    virtual void
    add_thermal_force(const CellRange &cells,
                      Vector          &force,
                      const Vector    &temperature) const = 0;

    /**
     * Integral of k D epsilon(u) : epsilon(v) over the points that are elastic
     * [J].
     *
     * @param history internal variables of the material; null: all of it is
     * elastic
     */
    virtual double
    work(const CellRange    &cells,
         const Vector       &u,
         const Vector       &v,
         const PointHistory *history) const = 0;

    /**
     * Largest eigenvalue of M^-1 K of each cell by itself [1/s2].
     * @param batch one batch of cells
     * @param masses lumped mass of the cell's nodes [kg], in the order of the
     *   dof values of one component
     */
    virtual Lanes
    element_eigenvalues(const CellRange                    &batch,
                        const dealii::AlignedVector<Lanes> &masses) const = 0;

    /** Tensile strength of a cell of this size [m] at the tip of a crack, over
     *  that of the material; see CrackTips. */
    virtual double
    tip_strength(const double cell_size) const = 0;

    /** Whether cracks grow from tips or along planes. */
    bool
    cracks_grow() const
    {
      return tip_strength(1.) < 1.;
    }

    /** Tensile strength [Pa]; 0: none. */
    virtual double
    tensile_strength() const = 0;

    /** Whether a point with these internal variables has a crack that may run
     *  on. */
    virtual bool
    is_cracked(const double *history) const = 0;

    /** Whether cracks have planes that go on from cell to cell; see
     *  CrackPlanes. */
    virtual bool
    cracks_along_planes() const = 0;

    /** Factor s on the damping memory, relative to the damping model. */
    virtual double
    damping_factor() const = 0;

    /** lambda + 2 G of the elastic law [Pa]. */
    virtual double
    wave_modulus() const = 0;
  };
} // namespace Voussoir

#endif
