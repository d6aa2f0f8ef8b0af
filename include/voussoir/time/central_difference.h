#ifndef voussoir_time_central_difference_h
#define voussoir_time_central_difference_h

#include <voussoir/constraints/projection.h>
#include <voussoir/fem/damping.h>
#include <voussoir/fem/initial_state.h>
#include <voussoir/fem/internal_force.h>
#include <voussoir/fem/lumped_mass.h>
#include <voussoir/fem/nodal_terms.h>
#include <voussoir/fem/state.h>

namespace Voussoir
{
  /**
   * Explicit central differences in leap-frog form,
   *   M (v+ - v-)/dt + C v + f(u_n) = F_0 + F_n,   u_(n+1) = u_n + dt v+ ,
   *
   * with the force F_0 that holds the static state and is always there.
   *
   * All diagonal damping (mass-proportional, dashpots) is treated centrally,
   * with v = (v+ + v-)/2, which costs no time step; with the paper's scheme
   * v = v- for all damping. Stiffness-proportional damping always uses v-.
   */
  class CentralDifference
  {
  public:
    /**
     * @param initial         where the motion starts
     * @param evaluate_loads  sets `terms.forces` for a time
     * @param after_step      called at the end of each step, for what marches
     *   beside the solid
     * @param base_acceleration acceleration of a rigid base [m/s2], or empty
     */
    CentralDifference(const Discretization                     &discretization,
                      const InternalForce                      &internal_force,
                      const LumpedMass                         &mass,
                      const Damping                            &damping,
                      NodalTerms                               &terms,
                      const InitialState                       &initial,
                      const std::vector<Projection *>          &projections,
                      const std::function<void(const double)>  &evaluate_loads,
                      const std::function<void(const State &)> &after_step,
                      const std::function<dealii::Tensor<1, 3>(const double)>
                                  &base_acceleration,
                      const bool   paper_scheme,
                      const double time_step);

    /** Advances the state by one step. */
    void
    step(State &state);

    /** The static state, at rest. */
    State
    state_at_rest() const;

    const double time_step;

    /** Work of the base acceleration and of the projections, loss by
     *  mass-proportional damping; this rank's, since the start [J]. */
    double work_of_base = 0., work_of_projections = 0., loss_by_mass = 0.;

  private:
    void
    update_memory(State             &state,
                  const unsigned int begin,
                  const unsigned int end);

    void
    update_motion(State                      &state,
                  const dealii::Tensor<1, 3> &base,
                  const unsigned int          begin,
                  const unsigned int          end);

    /** Lets the projections correct the motion, and the energies know it. */
    void
    project(State &state, const dealii::Tensor<1, 3> &base);

    const Discretization                             &discretization;
    const InternalForce                              &internal_force;
    const LumpedMass                                 &mass;
    NodalTerms                                       &terms;
    const InitialState                               &initial;
    const std::vector<Projection *>                   projections;
    const std::function<void(const double)>           evaluate_loads;
    const std::function<void(const State &)>          after_step;
    const std::function<dealii::Tensor<1, 3>(double)> base_acceleration;

    const unsigned int  n_branches;
    std::vector<double> decay, gain; // w <- decay w + gain v, of each branch
    double              mass_coefficient, stiffness_coefficient;
    bool                central;
    bool                damped, uniform; // stiffness damping, its factors
    double              uniform_factor;

    // nodes of the projections, slots of those with nodal terms, and their
    // velocity before the projections
    std::vector<unsigned int>                projected_nodes;
    std::vector<std::optional<unsigned int>> projected_slots;
    std::vector<dealii::Tensor<1, 3>>        predicted_velocity, last_velocity;

    Vector force;
    Vector effective; // u plus damping memory, or u where factors differ
    Vector memory;    // the memory by itself where factors differ
  };
} // namespace Voussoir

#endif
