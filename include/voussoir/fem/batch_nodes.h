#ifndef voussoir_fem_batch_nodes_h
#define voussoir_fem_batch_nodes_h

#include <voussoir/fem/discretization.h>

#include <deal.II/matrix_free/fe_evaluation.h>

#include <cstring>

namespace Voussoir
{
  /** Three numbers of a node and one more, which is not used. */
  typedef double Doubles4 __attribute__((vector_size(32)));

  /** Adds them to the entries of a node, in two instructions, each of which
   *  reads the whole of what one of the same kind has stored. Cell by cell this
   *  takes a third of the time of node by node over the cells of a batch. */
  inline void
  add_to_node(double *node, const Doubles4 &numbers)
  {
    typedef double Doubles2 __attribute__((vector_size(16)));
    Doubles2       first;
    std::memcpy(&first, node, sizeof(first));
    first += __builtin_shufflevector(numbers, numbers, 0, 1);
    std::memcpy(node, &first, sizeof(first));
    node[2] += numbers[2];
  }


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

    /** Corners of trilinear cells [m]: read like a displacement, which takes
     *  half the time of those of each cell in a row, as nodes are shared. */
    void
    read_corners(MatrixFree::Corners &corners) const;

    void
    read_dof_values(const Vector &vector);

    void
    distribute_local_to_global(Vector &vector);

  private:
    /** Reads the values of each node of a batch that has entries. */
    void
    read_nodes(const double *vector, Lanes *values) const;

    const MatrixFree &matrix_free;
    unsigned int      batch = 0;

    // of cells with hanging nodes, or without entries of their own
    dealii::FEEvaluation<3, -1, 0, 3, double> by_library;

    const unsigned int *entries = nullptr; // MatrixFree::node_entries
  };
} // namespace Voussoir

#endif
