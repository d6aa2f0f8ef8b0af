#ifndef voussoir_materials_cell_loops_h
#define voussoir_materials_cell_loops_h

#include <voussoir/fem/cell_kernel.h>
#include <voussoir/fem/trilinear_cells.h>

namespace Voussoir
{
  /** Common parts of the loops over the cells of a material. */
  namespace CellKernels
  {
    // degree and number of points are known at run time only: as fast as with
    // template arguments, and one instantiation serves all degrees
    using Evaluation = dealii::FEEvaluation<3, -1, 0, 3, double>;

    template <typename Cell>
    constexpr bool is_one_point =
      std::is_base_of_v<OnePointShape<Lanes>, std::decay_t<Cell>> ||
      std::is_base_of_v<OnePointShape<Singles>, std::decay_t<Cell>>;

    /** The cells of two batches in single precision. */
    template <typename Cell>
    using SingleCells =
      std::conditional_t<is_one_point<Cell>,
                         SingleTrilinearCells<OnePointShape>,
                         SingleTrilinearCells<EightPointShape>>;

    /** Calls work(cell) with the class of cells that suits these. */
    template <typename Work>
    void
    with_cells(const CellRange &cells, const Work &work)
    {
      if (cells.one_point)
        work(TrilinearCells<OnePointShape>(cells.matrix_free));
      else if (cells.matrix_free.trilinear)
        work(TrilinearCells<EightPointShape>(cells.matrix_free));
      else
        work(Evaluation(cells.matrix_free));
    }

    /** Stabilises cells with one point; full integration needs no
     *  stabilisation. */
    template <typename Cell, typename Law>
    void
    stabilise(Cell &cell, const Law &law, const double stress_factor)
    {
      if constexpr (is_one_point<Cell>)
        cell.submit_stabilisation(stress_factor * law.young_modulus,
                                  law.poisson_ratio);
      else
        (void)cell, (void)law, (void)stress_factor;
    }

    /** Adds the forces of the cells to those of their nodes. */
    template <typename Cell>
    void
    add_to_nodes(Cell &cell, const CellRange &cells, Vector &force)
    {
      if (cells.rounding != nullptr)
        (*cells.rounding)(cell.begin_dof_values(), cell.dofs_per_cell);
      cell.distribute_local_to_global(force);
    }

    /** Lanes beyond the last cell of a material hold copies. */
    inline double
    sum_of_cells(const Discretization::MatrixFree &matrix_free,
                 const unsigned int                batch,
                 const Lanes                      &values)
    {
      double sum = 0.;
      for (unsigned int lane = 0;
           lane < matrix_free.n_active_entries_per_cell_batch(batch);
           ++lane)
        sum += values[lane];
      return sum;
    }

    /** Adds a number of each cell of a batch, or their sum. */
    inline void
    add_cells(Sum               &sum,
              const CellRange   &cells,
              const unsigned int batch,
              const Lanes       &of_each)
    {
      for (unsigned int lane = 0;
           lane < cells.matrix_free.n_active_entries_per_cell_batch(batch);
           ++lane)
        sum += of_each[lane];
    }

    inline void
    add_cells(Sum &sum,
              const CellRange &,
              const unsigned int,
              const double of_all)
    {
      sum += of_all;
    }

    /** Calls work(reduce), where reduce(batch, values) adds up a number of each
     *  cell: each by itself, or their sum. */
    template <typename Work>
    void
    with_reduction(const CellRange &cells, const Work &work)
    {
      if (cells.exact_sums)
        work([](const unsigned int, const Lanes &values) { return values; });
      else
        work([&](const unsigned int batch, const Lanes &values) {
          return sum_of_cells(cells.matrix_free, batch, values);
        });
    }

    /** Reads x + s w of the cell. */
    template <typename Cell>
    void
    read_filtered(Cell             &cell,
                  const SweepInput &input,
                  const double      damping_factor)
    {
      cell.read_dof_values(input.filtered);
      if (input.damping != SweepInput::Damping::by_material)
        return;
      std::array<Lanes, 3 * 125> values; // up to degree 4
      const unsigned int         n = cell.dofs_per_cell;
      for (unsigned int i = 0; i < n; ++i)
        values[i] = cell.begin_dof_values()[i];
      cell.read_dof_values(*input.damping_memory);
      for (unsigned int i = 0; i < n; ++i)
        cell.begin_dof_values()[i] =
          values[i] + damping_factor * cell.begin_dof_values()[i];
    }


    /** Evaluates the strain of x + s w. */
    template <typename Cells>
    void
    evaluate_filtered(Cells            &cells,
                      const SweepInput &input,
                      const double      damping_factor)
    {
      if (input.damping == SweepInput::Damping::by_material)
        cells.gather_evaluate(input.filtered,
                              *input.damping_memory,
                              damping_factor);
      else
        cells.gather_evaluate(input.filtered);
    }
  } // namespace CellKernels
} // namespace Voussoir

#endif
