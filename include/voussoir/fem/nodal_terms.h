#ifndef voussoir_fem_nodal_terms_h
#define voussoir_fem_nodal_terms_h

#include <voussoir/fem/discretization.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <optional>

namespace Voussoir
{
  /** Applied force at each slot of the nodal terms [N]. */
  using NodalForces = std::vector<dealii::Tensor<1, 3>>;

  /**
   * What stands at a few nodes only, besides the cells: springs and dashpots of
   * the absorbing boundary, water that moves with the dam, the points where
   * loads act. All of owned nodes; `slot` numbers them.
   */
  class NodalTerms
  {
  public:
    using Matrix = dealii::SymmetricTensor<2, 3>;

    /** Slot of an owned node, made if it is new. */
    unsigned int
    add_node(const unsigned int node);

    std::vector<unsigned int> nodes;
    std::vector<Matrix>       springs;    // [N/m]
    std::vector<Matrix>       dashpots;   // [N s/m]
    std::vector<Matrix>       added_mass; // [kg]

    /** Slot of an owned node, or null if it has no terms. */
    std::optional<unsigned int>
    slot_at(const unsigned int node) const;

    /** Kinetic energy of the added mass, of this rank [J]. */
    double
    kinetic_energy(const Vector &velocity) const;

    /** Energy in the springs between two steps, u_n K u_(n-1) / 2, of this rank
     *  [J]. */
    double
    spring_energy(const Vector &displacement, const Vector &previous) const;

    /** Adds the springs' forces and @p dashpot_factor times what the dashpots
     *  make of the displacement [N]. */
    void
    add_to(Vector       &force,
           const Vector &displacement,
           const double  dashpot_factor) const;

  private:
    std::map<unsigned int, unsigned int> slot_of_node;
  };
} // namespace Voussoir

#endif
