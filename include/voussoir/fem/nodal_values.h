#ifndef voussoir_fem_nodal_values_h
#define voussoir_fem_nodal_values_h

#include <voussoir/fem/discretization.h>

#include <deal.II/base/tensor.h>

namespace Voussoir
{
  /** The three components of a vector at an owned node. */
  inline dealii::Tensor<1, 3>
  node_value(const Vector &vector, const unsigned int node)
  {
    dealii::Tensor<1, 3> value;
    for (unsigned int d = 0; d < 3; ++d)
      value[d] = vector.local_element(3 * node + d);
    return value;
  }

  /** With values at the nodes of other ranks and at hanging nodes. */
  Vector
  with_ghosts(const Discretization &discretization, const Vector &vector);

  /** Scalar product; @p reproducible: the same on any number of ranks, bit for
   *  bit. */
  double
  product(const Vector &a, const Vector &b, const bool reproducible);

  /** Sum over all nodes of all ranks. */
  dealii::Tensor<1, 3>
  resultant(const Vector &vector);

  /** Largest amount over all nodes of all ranks. */
  double
  largest_amount(const Vector &vector);
} // namespace Voussoir

#endif
