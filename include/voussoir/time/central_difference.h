#ifndef voussoir_time_central_difference_h
#define voussoir_time_central_difference_h

#include <voussoir/constraints/projection.h>
#include <voussoir/fem/damping.h>
#include <voussoir/fem/internal_force.h>
#include <voussoir/fem/lumped_mass.h>
#include <voussoir/fem/nodal_terms.h>
#include <voussoir/fem/state.h>

namespace Voussoir
{
  /**
   * Explicit central differences in leap-frog form,
   *   M (v+ - v-)/dt + C v + f(u_n) = F_n,   u_(n+1) = u_n + dt v+ .
   *
   * All diagonal damping (mass-proportional, dashpots) is treated centrally,
   * with v = (v+ + v-)/2, which costs no time step; with the paper's scheme
   * v = v- for all damping. Stiffness-proportional damping always uses v-.
   */
  class CentralDifference
  {
  public:
    /**
     * @param evaluate_loads  sets `terms.forces` for a time
     * @param base_acceleration acceleration of a rigid base [m/s2], or empty
     */
    CentralDifference(const Discretization                    &discretization,
                      const InternalForce                     &internal_force,
                      const LumpedMass                        &mass,
                      const Damping                           &damping,
                      NodalTerms                              &terms,
                      const std::vector<Projection *>         &projections,
                      const std::function<void(const double)> &evaluate_loads,
                      const std::function<dealii::Tensor<1, 3>(const double)>
                                  &base_acceleration,
                      const bool   paper_scheme,
                      const double time_step);

    /** Advances the state by one step. */
    void
    step(State &state);

    /** A state at rest. */
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

    const Discretization                             &discretization;
    const InternalForce                              &internal_force;
    const LumpedMass                                 &mass;
    NodalTerms                                       &terms;
    const std::vector<Projection *>                   projections;
    const std::function<void(const double)>           evaluate_loads;
    const std::function<dealii::Tensor<1, 3>(double)> base_acceleration;

    const unsigned int  n_branches;
    std::vector<double> decay, gain; // w <- decay w + gain v, of each branch
    double              mass_coefficient, stiffness_coefficient;
    bool                central;
    bool                uniform;
    double              uniform_factor;

    Vector force;
    Vector effective; // u plus damping memory, or u where factors differ
    Vector memory;    // the memory by itself where factors differ
  };
} // namespace Voussoir

#endif
