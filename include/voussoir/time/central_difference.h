#ifndef voussoir_time_central_difference_h
#define voussoir_time_central_difference_h

#include <voussoir/constraints/projection.h>
#include <voussoir/fem/crack_planes.h>
#include <voussoir/fem/crack_tips.h>
#include <voussoir/fem/damping.h>
#include <voussoir/fem/initial_state.h>
#include <voussoir/fem/internal_force.h>
#include <voussoir/fem/lumped_mass.h>
#include <voussoir/loads/nodal_load.h>
#include <voussoir/loads/rigid_base.h>
#include <voussoir/time/nodal_update.h>

namespace Voussoir
{
  /**
   * The equation that is integrated in time:
   *   M a + C v + f(u) + K_b u = F_0 + F(t) - M_driven a_base
   * and the constraints. All members must live as long as the scheme.
   */
  struct EquationOfMotion
  {
    const Discretization &discretization;
    const InternalForce  &internal_force; // f(u)
    const LumpedMass     &mass;           // M
    const NodalTerms     &terms;          // boundary K_b and C, added mass
    const Damping        &damping;
    const InitialState
      &initial; // where the motion starts, and F_0 in equilibrium with it

    std::vector<NodalLoad *>  loads       = {}; // F(t), in their order
    std::vector<Projection *> projections = {}; // in their order
    const RigidBase          *base = nullptr; // null: the ground does not move

    double closing_viscosity = 0.; // c of DampedResponse [s]

    const CrackTips *crack_tips   = nullptr; // null: cracks have none
    CrackPlanes     *crack_planes = nullptr; // null: cracks have none
  };

  /** Explicit central differences in leap-frog form; see LeapFrog. */
  class CentralDifference
  {
  public:
    CentralDifference(const EquationOfMotion &equation,
                      const LeapFrog         &leap_frog);

    /** The static state, without motion. */
    State
    initial_state() const;

    /** Advances the state by one step. */
    void
    step(State &state);

    /** Force of supports and prescribed motions on an owned node at the
     *  beginning of the last step, beyond that of the static state and without
     *  the inertia of a fixed node itself, which is not known here [N]. */
    dealii::Tensor<1, 3>
    support_force(const State &state, const unsigned int node) const;

    /** Time that this rank took for its cells, so far [s]. */
    double
    seconds_of_cells() const;

    const double time_step; // [s]

  private:
    /** Effective mass of an owned node: impulse over change of velocity [kg];
     *  zero where fixed. */
    dealii::Tensor<2, 3>
    mass_at(const unsigned int node) const;

    void
    initialize_projections();

    /** Rounding of the force of the step from a state; none if sums need not be
     *  reproducible, or if the force does not follow from the motion alone. */
    std::optional<MotionBound>
    bound_of_motion(const State &state) const;

    void
    update_memory(State             &state,
                  const unsigned int begin,
                  const unsigned int end);

    void
    update_motion(State                      &state,
                  const dealii::Tensor<1, 3> &base,
                  const unsigned int          begin,
                  const unsigned int          end);

    /** Corrects the motion by the projections, and updates the energies. */
    void
    project(State &state, const dealii::Tensor<1, 3> &base);

    /** Adds to the energies the work of loads and damping on a node whose
     *  velocity the projections changed. */
    void
    account_for_projection(const unsigned int          i,
                           const dealii::Tensor<1, 3> &base,
                           State                      &state) const;

    const EquationOfMotion equation;
    const LeapFrog         leap_frog;
    const MaxwellStep      maxwell;
    NodalUpdate            nodal_update;
    const double           mass_coefficient, stiffness_coefficient;
    const PointStep        point_step;
    const bool             uniform; // damping factors

    // nodes of the projections, slots of those with nodal terms, and their
    // velocity before the step and before the projections
    std::vector<unsigned int>                projected_nodes;
    std::vector<std::optional<unsigned int>> projected_slots;
    std::vector<dealii::Tensor<1, 3>>        last_velocity, predicted_velocity;

    NodalForces forces;    // F_n
    Vector      force;     // f(u_n) - F_0
    Vector      effective; // u + beta v and, if factors are uniform, the memory
    Vector      memory;    // of damping, where factors differ

    double time_of_cells = 0.; // [s]
  };
} // namespace Voussoir

#endif
