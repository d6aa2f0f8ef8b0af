#include <voussoir/base/mpi.h>
#include <voussoir/fem/lumped_mass.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>

namespace Voussoir
{
  using namespace dealii;

  NodalVolumes::NodalVolumes(const Discretization &discretization)
    : values(discretization.mapping,
             discretization.fe.base_element(0),
             QGaussLobatto<3>(discretization.degree + 1),
             update_JxW_values)
    , from_corners(discretization.degree == 1)
    , volumes(discretization.fe.base_element(0).n_dofs_per_cell())
  {
    // the points are the nodes, in lexicographic instead of hierarchic order
    const auto &scalar =
      dynamic_cast<const FE_Q<3> &>(discretization.fe.base_element(0));
    node_of_point = scalar.get_poly_space_numbering_inverse();
  }


  const std::vector<double> &
  NodalVolumes::of(const Triangulation<3>::active_cell_iterator &cell)
  {
    if (from_corners)
      {
        // as FEValues, which are slow, and with reproducible sums must not
        // reuse the values of a previous cell of the same shape
        for (unsigned int v = 0; v < 8; ++v)
          {
            Tensor<2, 3> edges;
            for (unsigned int k = 0; k < 3; ++k)
              edges[k] =
                cell->vertex(v | (1 << k)) - cell->vertex(v & ~(1 << k));
            volumes[v] = 0.125 * determinant(edges);
          }
        return volumes;
      }
    values.reinit(cell);
    for (unsigned int q = 0; q < volumes.size(); ++q)
      volumes[node_of_point[q]] = values.JxW(q);
    return volumes;
  }


  LumpedMass::LumpedMass(const Discretization      &discretization,
                         const std::vector<double> &density,
                         const std::vector<double> &driven_density)
    : mass(discretization.create_vector())
    , inverse(mass)
    , part(driven_density == density ? Vector() : mass)
    , total(density.size())
  {
    const MPI_Comm communicator = discretization.grid.communicator();
    Vector         full(discretization.owned_dofs,
                discretization.relevant_dofs,
                communicator);
    Vector         full_driven(full);
    using Masses = std::array<double, 2>; // full and driven
    std::vector<std::pair<types::global_dof_index, Masses>> records;

    const auto            &scalar = discretization.fe.base_element(0);
    NodalVolumes           nodal_volumes(discretization);
    dealii::Vector<double> cell_mass(discretization.fe.n_dofs_per_cell());
    dealii::Vector<double> cell_driven(cell_mass);
    std::vector<types::global_dof_index> dofs(cell_mass.size());
    for (const auto &cell : discretization.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int material = discretization.grid.material(cell);
          const auto        &volumes  = nodal_volumes.of(cell);
          for (unsigned int j = 0; j < scalar.n_dofs_per_cell(); ++j)
            {
              total[material] += density[material] * volumes[j];
              for (unsigned int d = 0; d < 3; ++d)
                {
                  const auto i =
                    discretization.fe.component_to_system_index(d, j);
                  cell_mass[i]   = density[material] * volumes[j];
                  cell_driven[i] = driven_density[material] * volumes[j];
                }
            }
          if (discretization.reproducible)
            {
              const auto nodes = discretization.cell_nodes(cell);
              for (unsigned int j = 0; j < nodes.size(); ++j)
                for (const auto &share : discretization.carriers(nodes[j]))
                  records.push_back(
                    {share.node,
                     {{share.weight * density[material] * volumes[j],
                       share.weight * driven_density[material] * volumes[j]}}});
              continue;
            }
          cell->get_dof_indices(dofs);
          // row sum of C^T M C for the hanging nodes
          discretization.hanging_nodes.distribute_local_to_global(cell_mass,
                                                                  dofs,
                                                                  full);
          discretization.hanging_nodes.distribute_local_to_global(cell_driven,
                                                                  dofs,
                                                                  full_driven);
        }
    full.compress(VectorOperation::add);
    full_driven.compress(VectorOperation::add);
    for (const auto &[node, masses] : discretization.send_to_owners(records))
      for (unsigned int d = 0; d < 3; ++d)
        {
          full.local_element(3 * node + d) += masses[0];
          full_driven.local_element(3 * node + d) += masses[1];
        }
    total = sum_over_ranks(total, communicator);

    for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
      if (!discretization.constraints.is_constrained(
            discretization.owned_dofs.nth_index_in_set(i)))
        {
          mass.local_element(i)    = full.local_element(i);
          inverse.local_element(i) = 1. / full.local_element(i);
          if (part.size() > 0)
            part.local_element(i) = full_driven.local_element(i);
        }
  }
} // namespace Voussoir
