#include <voussoir/base/mpi.h>
#include <voussoir/base/reproducible_sum.h>
#include <voussoir/fem/nodal_values.h>

namespace Voussoir
{
  using namespace dealii;

  Vector
  with_ghosts(const Discretization &discretization, const Vector &vector)
  {
    Vector full(discretization.owned_dofs,
                discretization.relevant_dofs,
                discretization.grid.communicator());
    full.copy_locally_owned_data_from(vector);
    full.update_ghost_values();
    discretization.hanging_nodes.distribute(full);
    full.update_ghost_values();
    return full;
  }


  double
  product(const Vector &a, const Vector &b, const bool reproducible)
  {
    if (!reproducible)
      return a * b;
    std::vector<double> terms(a.locally_owned_size());
    for (unsigned int i = 0; i < terms.size(); ++i)
      terms[i] = a.local_element(i) * b.local_element(i);
    return reproducible_sum(terms, a.get_mpi_communicator());
  }


  Tensor<1, 3>
  resultant(const Vector &vector)
  {
    std::vector<double> sums(3);
    for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
      sums[i % 3] += vector.local_element(i);
    sums = sum_over_ranks(sums, vector.get_mpi_communicator());
    return Tensor<1, 3>({sums[0], sums[1], sums[2]});
  }


  double
  largest_amount(const Vector &vector)
  {
    double largest = 0.;
    for (unsigned int node = 0; 3 * node < vector.locally_owned_size(); ++node)
      largest = std::max(largest, node_value(vector, node).norm());
    return Utilities::MPI::max(largest, vector.get_mpi_communicator());
  }
} // namespace Voussoir
