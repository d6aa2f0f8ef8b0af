#ifndef voussoir_fem_nodal_terms_h
#define voussoir_fem_nodal_terms_h

#include <voussoir/base/sum.h>
#include <voussoir/fem/discretization.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <optional>

namespace Voussoir
{
  /** Contribution of a boundary, of water or of a load to an owned node. */
  struct NodalTerm
  {
    using Matrix = dealii::SymmetricTensor<2, 3>;

    unsigned int node;
    Matrix       spring, dashpot; // [N/m], [N s/m]
    Matrix       added_mass;      // [kg]
  };

  /**
   * Terms of the equation of motion that act at a few nodes only: springs and
   * dashpots of the absorbing boundary, added mass, forces of loads. All nodes
   * are owned ones; `slot` numbers those that have any term.
   */
  class NodalTerms
  {
  public:
    using Matrix = NodalTerm::Matrix;

    explicit NodalTerms(const unsigned int n_owned_nodes);

    /** Adds to the terms of the nodes. */
    void
    add(const std::vector<NodalTerm> &terms);

    /** Gives slots to nodes that forces act on. */
    void
    add_nodes(const std::vector<unsigned int> &nodes);

    std::vector<unsigned int> nodes;
    std::vector<Matrix>       springs;    // [N/m]
    std::vector<Matrix>       dashpots;   // [N s/m]
    std::vector<Matrix>       added_mass; // [kg]

    /** Slot of an owned node, or null if it has no terms. */
    std::optional<unsigned int>
    slot_at(const unsigned int node) const;

    /** Kinetic energy of the added mass, of this rank [J]. */
    Sum
    kinetic_energy(const Vector &velocity, const bool exact = false) const;

    /** Energy in the springs between two steps, u_n K (u_n - dt v) / 2, of this
     *  rank [J]. */
    Sum
    spring_energy(const Vector &displacement,
                  const Vector &velocity,
                  const double  time_step,
                  const bool    exact = false) const;

    /** Adds the forces of the springs and @p dashpot_factor times the product
     *  of the dashpot matrix with the displacement [N]. */
    void
    add_to(Vector       &force,
           const Vector &displacement,
           const double  dashpot_factor) const;

  private:
    friend class NodalForces;

    unsigned int
    slot_made_at(const unsigned int node);

    std::vector<unsigned int> slot_of_node; // invalid without terms
  };

  /** Applied forces at the nodes that have terms [N]. */
  class NodalForces
  {
  public:
    /** Forces of zero. @param terms must live as long as this */
    explicit NodalForces(const NodalTerms &terms);

    void
    reset();

    /** @param node that has a slot */
    void
    add(const unsigned int node, const dealii::Tensor<1, 3> &force)
    {
      values[slots[node]] += force;
    }

    const dealii::Tensor<1, 3> &
    of_slot(const unsigned int slot) const
    {
      return values[slot];
    }

    /** Sum over the nodes of this rank. */
    dealii::Tensor<1, 3>
    sum() const;

  private:
    const std::vector<unsigned int>  &slots;
    std::vector<dealii::Tensor<1, 3>> values;
  };
} // namespace Voussoir

#endif
