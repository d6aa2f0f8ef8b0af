#ifndef voussoir_time_nodal_update_h
#define voussoir_time_nodal_update_h

#include <voussoir/fem/leap_frog.h>
#include <voussoir/fem/lumped_mass.h>
#include <voussoir/fem/nodal_terms.h>
#include <voussoir/fem/state.h>

namespace Voussoir
{
  /**
   * The part of a step that belongs to the nodes with springs, dashpots, added
   * mass or forces. The sweep over the cells advances these nodes without such
   * terms; then they are corrected to (M + M_a + dt/2 C) v+ = M v* + M_a (v- -
   * dt a_base) + dt (F - K u) - dt/2 C v- , with the matrices of NodalTerms, C
   * with alpha M_a (TimeScheme::paper: dt C v- on the right alone).
   */
  class NodalUpdate
  {
  public:
    /** @param mass_coefficient alpha of mass-proportional damping [1/s] */
    NodalUpdate(const NodalTerms &terms,
                const LumpedMass &mass,
                const double      mass_coefficient,
                const LeapFrog   &leap_frog);

    /** Matrix by which the update divides at an owned node [kg], without rows
     *  and columns where fixed, or null if the node has no terms. */
    std::optional<dealii::Tensor<2, 3>>
    mass_at(const unsigned int node) const;

    /** Reaction of the fixed components of a node, besides that to the forces
     *  of cells, in the step that ends with the velocity @p next [N]. */
    dealii::Tensor<1, 3>
    holding_force(const unsigned int          slot,
                  const dealii::Tensor<1, 3> &next) const;

    /** Stores the data of the state before the step for the correction.
     *  @param base acceleration of a rigid base, which acts on the added mass
     *  [m/s2] */
    void
    before_step(const State &state, const dealii::Tensor<1, 3> &base);

    /** Corrects displacement and velocity after the sweep, with the forces at
     *  the beginning of the step [N]. */
    void
    correct(State &state, const NodalForces &forces);

    /** Adds to the energies the work of a @p change of the velocity at the end
     *  of the step, after `correct`. */
    void
    account_for(const unsigned int          slot,
                const dealii::Tensor<1, 3> &velocity,
                const dealii::Tensor<1, 3> &change,
                EnergyAccounts             &accounts) const;

  private:
    const NodalTerms                 &terms;
    const LumpedMass                 &mass;
    const double                      mass_coefficient;
    const LeapFrog                    leap_frog;
    std::vector<dealii::Tensor<2, 3>> inverse;
    std::vector<dealii::Tensor<1, 3>> masses;    // diagonal
    std::vector<bool>                 has_water; // added mass
    std::vector<dealii::Tensor<1, 3>> applied;   // F - M_a a_base
    std::vector<dealii::Tensor<1, 3>> last_displacement, last_velocity;
    dealii::Tensor<1, 3>              base;
  };
} // namespace Voussoir

#endif
