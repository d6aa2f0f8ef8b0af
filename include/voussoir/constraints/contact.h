#ifndef voussoir_constraints_contact_h
#define voussoir_constraints_contact_h

#include <voussoir/base/keyed_values.h>
#include <voussoir/constraints/bond_tips.h>
#include <voussoir/constraints/contact_solver.h>
#include <voussoir/constraints/interface_points.h>
#include <voussoir/constraints/projection.h>

#include <nlohmann/json.hpp>

#include <chrono>

namespace Voussoir
{
  /**
   * Contact between the two sides of all interfaces of a case: after each step
   * no point has penetrated the other side, and points have opened and slipped
   * only as their law admits. A copy has a state of its own, which begins as
   * that of the original.
   */
  class Contact : public Projection
  {
  public:
    /** @param parameters of the interfaces along which the mesh is split; must
     * live as long as this */
    Contact(const Discretization       &discretization,
            const InterfacesParameters &parameters,
            const InterfaceSurfaces    &surfaces);

    /** The points, for another solver of the same forces. */
    InterfacePoints &
    points_of_interfaces();

    /** Lets friction follow the pressure as fast as waves of this speed [m/s]
     *  pass the adjacent cells (see ContactPoint::delay); returns the largest
     *  delay [s]. */
    double
    set_delay(const Discretization                            &discretization,
              const std::function<double(const Grid::Cell &)> &wave_speed);

    /** Prepares the search for tips of cracks along bonds. */
    void
    prepare_tips(const Solid &solid);

    /** Null if no crack along a bond grows from its tips. */
    BondTips *
    bond_tips();

    /** From now on moduli are those of the earthquake. */
    void
    begin_earthquake();

    void
    prepare_step(const InverseMass &inverse_mass,
                 const double       time_step) override;

    void
    start(const State &state) override;

    Result
    project(State &state, const double time_step) override;

    const std::vector<unsigned int> &
    nodes() const override;

    /** Adds @p factor times the forces of the last step, of uplift and bars too
     *  [N]. */
    void
    add_forces(const double factor, Vector &force) const;

    /** State of each point for a checkpoint; `load` restores the state from
     * these numbers once they have been read. */
    KeyedValues
    checkpoint_values();

    /** Energies of the surfaces of this rank, one after the other [J]. */
    std::vector<double *>
    energies();

    /** Other state for a checkpoint. Called on all ranks. */
    nlohmann::json
    save() const;

    /** Called after the numbers of `checkpoint_values` have been read. */
    void
    load(const nlohmann::json &saved);

    /** Called after `start` where a run continues from a checkpoint: restores
     *  gaps and velocities of its last step, which differ by round-off from
     *  those that `start` finds from the nodes. */
    void
    resume();

    /** Begins the dynamic relaxation of a static stage, in which points
     * oscillate. */
    void
    begin_approach();

    /** Removes these oscillations, which open joints that end closed, from the
     * history, which then is that before the relaxation, followed by a
     * monotonic change to the present gap and slip. */
    void
    forget_approach();

    /** Applies the uplift of the interfaces whose water comes with one of these
     *  loads. */
    void
    apply_uplift(const std::vector<std::string> &loads);

    /** Joins the interfaces that are grouted after one of these loads; returns
     *  whether there are any. Called on all ranks.
     *  @param displacement from which gap and slip count */
    bool
    grout(const std::vector<std::string> &loads, const Vector &displacement);

    /** Statistics of the solver: largest values and sums over all ranks since
     * the start. Called on all ranks. */
    ContactSolver::Effort
    effort() const;

    /** Wall time of this rank in the steps since the static state [s]. */
    double
    seconds() const;

    /** Names of the surfaces (face sets of all interfaces). */
    const std::vector<std::string> &
    surface_names() const;

    /** Energies of each surface, of this rank [J]. */
    const std::vector<ContactSurface> &
    surfaces() const;

    /** The points of this rank and their positions. */
    const std::vector<ContactPoint> &
    points() const;

    /** Restores an earlier state of the points. */
    void
    set_points(const std::vector<ContactPoint> &points);

    const std::vector<dealii::Point<3>> &
    positions() const;

    /** Whether the sides of a point touch, to a millionth of a cell. */
    bool
    touches(const ContactPoint &point) const;

    /** Identifiers of the points, the same on all partitions. */
    const std::vector<std::uint64_t> &
    keys() const;

    /** Global node on the first side of each point. */
    const std::vector<dealii::types::global_dof_index> &
    first_nodes() const;

    /** Smallest side of a cell at the interfaces [m]. */
    double
    cell_size() const;

    /** Global nodes of the clusters of this rank. */
    const std::vector<dealii::types::global_dof_index> &
    cluster_nodes() const;

  private:
    static constexpr unsigned int memory_width = 21;
    using PointMemory = std::array<double, memory_width>;

    bool                     exact_sums; // of the work
    InterfacePoints          interfaces;
    ContactSolver            solver;
    std::optional<BondTips>  tips;
    std::vector<PointMemory> point_memory;

    struct Slid
    {
      InterfaceHistory     history;
      dealii::Tensor<1, 2> stick_point;   // [m]
      double               bar_extension; // [m]
      double               largest_slip;  // [m]
    };
    std::vector<Slid> before_approach; // of each point

    // at the nodes of the clusters
    std::vector<dealii::Tensor<1, 3>> displacement, force;

    // at the owned nodes
    std::vector<double>               compliance; // [m/N], -1: full
    std::vector<dealii::Tensor<2, 3>> full_compliance;
    std::vector<dealii::Tensor<1, 3>> applied, last_velocity;

    ContactSolver::Effort total;

    std::chrono::duration<double> wall_time{0.};
  };
} // namespace Voussoir

#endif
