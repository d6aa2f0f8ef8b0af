#ifndef voussoir_constraints_static_contact_h
#define voussoir_constraints_static_contact_h

#include <voussoir/constraints/bond_tips.h>

namespace Voussoir
{
  /**
   * The interfaces in static equilibrium, by the augmented Lagrangian of Alart
   * and Curnier (1991): the force of a point is the projection of F - r g to
   * the admissible forces of its law , with the gap g, a spring r and the
   * multiplier F. Once F equals that force, the law holds exactly, for any r.
   * Slip counts from the last stick, as in a step of the run.
   */
  class StaticContact
  {
  public:
    /**
     * @param interfaces whose forces are found; must live as long as this
     * @param stiffness  of the body at the owned nodes [N/m], zero where fixed
     * @param tips       of cracks along the interfaces, or null
     */
    StaticContact(InterfacePoints &interfaces,
                  const Vector    &stiffness,
                  BondTips        *tips);

    /** A stage starts from the present forces and slips. */
    void
    start_stage();

    /** Adds the forces at a displacement [N]; `add_tangent` is then the tangent
     * at this displacement. */
    void
    respond(Vector &force, const Vector &displacement);

    /**
     * Moves the tangent by a share towards that of sticking points; 1: all the
     * way. With that tangent no block is detached, and no step goes too far.
     */
    void
    stiffen(const double share);

    /** From now on the tangent is that of the closed points, taken as sticking.
     */
    void
    tie(const Vector &displacement);

    /** force += C displacement, where -C is the derivative of the forces,
     *  without that of the friction by the pressure. */
    void
    add_tangent(Vector &force, const Vector &displacement) const;

    /** Two nodes of a tangent: C on the diagonal, -C beside it. */
    struct Pair
    {
      dealii::types::global_dof_index first, second; // global nodes
      dealii::Tensor<2, 3>            tangent;       // [N/m]
      std::array<bool, 3>             first_fixed, second_fixed;
    };

    /** The pairs of this rank, whose nodes may be owned by others. */
    std::vector<Pair>
    pairs() const;

    /** Changes by an update of the multipliers, on all ranks. */
    struct Change
    {
      double       force  = 0.; // norm of the change over that of the forces
      unsigned int broken = 0;  // points whose strength has changed
      unsigned int open = 0, slide = 0, all = 0; // points
    };

    /** The forces last evaluated become the multipliers; the history of the
     * points is updated by their opening and slip. */
    Change
    update();

    /** Weakens the points at the tips of cracks in this equilibrium; returns
     *  whether there are any that were not weak before, on all ranks. */
    bool
    find_tips();

    /** Updates the history of the points by opening and slip of this stage; the
     * slip of the next stage counts from here. */
    void
    finish_stage();

    /** Restores the state at the beginning of this stage. */
    void
    restore();

  private:
    void
    find_gaps(const Vector &displacement);

    /** History of point @p k if this stage ended now. */
    InterfaceHistory
    history_at(const unsigned int k) const;

    /** Adds the forces at the nodes of the clusters. */
    void
    add_forces(Vector &force) const;

    InterfacePoints                  &interfaces;
    BondTips                         *tips;
    std::vector<double>               spring; // of each point [N/m]
    std::vector<dealii::Tensor<1, 3>> multiplier, last_change;
    std::vector<double>               cohesion; // its multiplier [N]
    std::vector<double>               closing;  // see closing_force [N]
    std::vector<dealii::Tensor<2, 3>> tangent;  // in global axes
    std::vector<ContactPoint>         before;   // this stage

    // at the nodes of the clusters and at the owned ones
    mutable std::vector<dealii::Tensor<1, 3>> at_nodes, forces, at_owned;
    std::vector<std::array<bool, 3>>          fixed; // nodes of the clusters
  };
} // namespace Voussoir

#endif
