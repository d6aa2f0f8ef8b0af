#include <voussoir/fem/acoustic_space.h>
#include <voussoir/fem/face_nodes.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/matrix_free/fe_evaluation.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    GridParameters
    without_local_refinement(GridParameters parameters)
    {
      parameters.local_refinement.clear();
      parameters.refine_where = {};
      return parameters;
    }
  } // namespace


  AcousticSpace::AcousticSpace(const CoarseMesh     &mesh,
                               const GridParameters &parameters,
                               const unsigned int    degree,
                               const MPI_Comm        communicator)
    : grid(mesh, without_local_refinement(parameters), communicator)
    , fe(degree)
    , dof_handler(grid.triangulation())
  {
    dof_handler.distribute_dofs(fe);
    owned_dofs = dof_handler.locally_owned_dofs();
    DoFTools::extract_locally_relevant_dofs(dof_handler, relevant_dofs);
    AffineConstraints<double> no_constraints(relevant_dofs);
    no_constraints.close();

    MatrixFree::AdditionalData data;
    data.tasks_parallel_scheme = MatrixFree::AdditionalData::none;
    data.mapping_update_flags  = update_gradients | update_JxW_values;
    matrix_free.reinit(
      mapping, dof_handler, no_constraints, QGauss<1>(degree + 1), data);

    // the points are the nodes, in lexicographic instead of hierarchic order
    const auto  node_of_point = fe.get_poly_space_numbering_inverse();
    FEValues<3> values(mapping,
                       fe,
                       QGaussLobatto<3>(degree + 1),
                       update_quadrature_points | update_JxW_values);
    Vector      full = create_ghosted_vector();
    node_positions.resize(owned_dofs.n_elements());
    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          cell->get_dof_indices(dofs);
          for (const unsigned int q : values.quadrature_point_indices())
            {
              const auto dof = dofs[node_of_point[q]];
              full(dof) += values.JxW(q);
              if (owned_dofs.is_element(dof))
                node_positions[owned_dofs.index_within_set(dof)] =
                  values.quadrature_point(q);
            }
        }
    full.compress(VectorOperation::add);
    volumes = create_vector();
    volumes.copy_locally_owned_data_from(full);
  }


  Vector
  AcousticSpace::create_vector() const
  {
    Vector vector;
    matrix_free.initialize_dof_vector(vector);
    return vector;
  }


  Vector
  AcousticSpace::create_ghosted_vector() const
  {
    return Vector(owned_dofs, relevant_dofs, grid.communicator());
  }


  Vector
  AcousticSpace::areas(const FacePredicate &wanted) const
  {
    FaceNodes                            face_nodes(mapping, fe);
    Vector                               full = create_ghosted_vector();
    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int face : cell->face_indices())
          if (cell->at_boundary(face) && wanted(cell, face))
            {
              cell->get_dof_indices(dofs);
              for (const FaceNode &node : face_nodes.of(cell, face))
                full(dofs[node.number]) += node.area;
            }
    full.compress(VectorOperation::add);
    Vector result = create_vector();
    result.copy_locally_owned_data_from(full);
    return result;
  }


  void
  AcousticSpace::sweep(Vector                         &result,
                       const Vector                   &source,
                       const InternalForce::RangeWork &before,
                       const InternalForce::RangeWork &after) const
  {
    const std::function<void(const MatrixFree &,
                             Vector &,
                             const Vector &,
                             const std::pair<unsigned int, unsigned int> &)>
      cells = [](const MatrixFree                            &matrix_free,
                 Vector                                      &dst,
                 const Vector                                &src,
                 const std::pair<unsigned int, unsigned int> &range) {
        // degree and number of points are known at run time only
        FEEvaluation<3, -1, 0, 1, double> cell(matrix_free);
        for (unsigned int batch = range.first; batch < range.second; ++batch)
          {
            cell.reinit(batch);
            cell.gather_evaluate(src, EvaluationFlags::gradients);
            for (const unsigned int q : cell.quadrature_point_indices())
              cell.submit_gradient(cell.get_gradient(q), q);
            cell.integrate_scatter(EvaluationFlags::gradients, dst);
          }
      };
    matrix_free.cell_loop(cells, result, source, before, after);
  }


  std::vector<std::uint64_t>
  AcousticSpace::node_keys() const
  {
    // The smallest (cell, place in the cell) among the cells around a node:
    // all of them are owned or ghosts where the node is owned.
    std::vector<std::uint64_t>           keys(owned_dofs.n_elements(),
                                    std::numeric_limits<std::uint64_t>::max());
    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        {
          cell->get_dof_indices(dofs);
          const std::uint64_t first = Grid::global_key(cell) * 128;
          for (unsigned int j = 0; j < dofs.size(); ++j)
            if (owned_dofs.is_element(dofs[j]))
              {
                auto &key = keys[owned_dofs.index_within_set(dofs[j])];
                key       = std::min(key, first + j);
              }
        }
    return keys;
  }
} // namespace Voussoir
