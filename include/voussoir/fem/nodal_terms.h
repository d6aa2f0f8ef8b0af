#ifndef voussoir_fem_nodal_terms_h
#define voussoir_fem_nodal_terms_h

#include <voussoir/fem/lumped_mass.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <optional>

namespace Voussoir
{
  /**
   * What acts on a few nodes only: springs and dashpots of the absorbing
   * boundary, water that moves with the dam, applied forces. All of owned
   * nodes; `slot` numbers them.
   */
  class NodalTerms
  {
  public:
    using Matrix = dealii::SymmetricTensor<2, 3>;

    /** Slot of an owned node, made if it is new. */
    unsigned int
    add_node(const unsigned int node);

    std::vector<unsigned int>         nodes;
    std::vector<Matrix>               springs;    // [N/m]
    std::vector<Matrix>               dashpots;   // [N s/m]
    std::vector<Matrix>               added_mass; // [kg]
    std::vector<dealii::Tensor<1, 3>> forces;     // of the present step [N]

    /**
     * Makes the inverses of M + M_a + dt/2 (alpha M + C) for the step. Without
     * @p central the dashpots act on the velocity of the last half step instead
     * (the paper's scheme), and the inverse is that of M + M_a.
     */
    void
    prepare(const LumpedMass &mass,
            const double      mass_coefficient,
            const double      time_step,
            const bool        central);

    /** Slot of an owned node, or null if it has no terms. */
    std::optional<unsigned int>
    slot_at(const unsigned int node) const;

    /** The inverse that `prepare` made for an owned node, zero where held, or
     *  null if it has no terms. */
    std::optional<dealii::Tensor<2, 3>>
    inverse_at(const unsigned int node) const;

    /** Takes into the energies that the velocity at the end of the step was
     *  changed by @p change after `correct`. */
    void
    account_for(const unsigned int          slot,
                const dealii::Tensor<1, 3> &velocity,
                const dealii::Tensor<1, 3> &change);

    /** Keeps what the correction needs of the state before the step.
     *  @p base: acceleration of a rigid base, which the added mass feels. */
    void
    before_step(const Vector               &displacement,
                const Vector               &velocity,
                const dealii::Tensor<1, 3> &base);

    /**
     * Corrects displacement and velocity, which the step advanced as if these
     * terms did not exist:
     *   (M + M_a + dt/2 C) v+
     *     = M v* + M_a (v- - dt a_base) + dt (F - K u) - dt/2 C v- .
     */
    void
    correct(Vector &displacement, Vector &velocity);

    /** Work of the forces, loss in the dashpots since the start [J]. */
    double work_of_forces = 0., loss_in_dashpots = 0.;

    /** Kinetic energy of the added mass [J]. */
    double
    kinetic_energy(const Vector &velocity) const;

    /** Energy in the springs between two steps, u_n K u_(n-1) / 2 [J]. */
    double
    spring_energy(const Vector &displacement, const Vector &velocity) const;

    /** Adds the springs, and the dashpots times @p dashpot_factor. */
    void
    add_to(Vector       &force,
           const Vector &displacement,
           const double  dashpot_factor) const;

  private:
    std::map<unsigned int, unsigned int> slot_of_node;
    std::vector<dealii::Tensor<2, 3>>    inverse;
    std::vector<dealii::Tensor<1, 3>>    masses; // diagonal
    std::vector<dealii::Tensor<1, 3>>    last_displacement, last_velocity;
    dealii::Tensor<1, 3>                 base;
    double                               time_step = 0.;
    bool                                 central   = true;
  };
} // namespace Voussoir

#endif
