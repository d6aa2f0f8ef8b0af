#ifndef voussoir_fem_batch_nodes_h
#define voussoir_fem_batch_nodes_h

#include <voussoir/fem/discretization.h>

#include <deal.II/matrix_free/fe_evaluation.h>

namespace Voussoir
{
  /** Values at the nodes of the cells of a batch, component by component: of
   *  trilinear cells entry 8 d + v is that of node v. All cell loops read nodes
   *  through this class, as deal.II keeps no entries of most trilinear cells.
   */
  class BatchNodes
  {
  public:
    using MatrixFree = Discretization::MatrixFree;

    explicit BatchNodes(const MatrixFree &matrix_free)
      : dofs_per_cell(matrix_free.get_dofs_per_cell())
      , matrix_free(matrix_free)
      , by_library(matrix_free)
    {}

    const unsigned int dofs_per_cell;

    void
    reinit(const unsigned int batch);

    Lanes *
    begin_dof_values()
    {
      return by_library.begin_dof_values();
    }

    const Lanes *
    begin_dof_values() const
    {
      return by_library.begin_dof_values();
    }

    void
    read_dof_values(const Vector &vector);

    void
    distribute_local_to_global(Vector &vector);

  private:
    const MatrixFree &matrix_free;

    // of cells with hanging nodes, or without entries of their own
    dealii::FEEvaluation<3, -1, 0, 3, double> by_library;

    const unsigned int *entries = nullptr; // MatrixFree::node_entries
  };
} // namespace Voussoir

#endif
