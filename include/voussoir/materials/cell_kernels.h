#ifndef voussoir_materials_cell_kernels_h
#define voussoir_materials_cell_kernels_h

#include <voussoir/materials/cell_loops.h>
#include <voussoir/materials/damped_response.h>

namespace Voussoir
{
  /**
   * The loops over the cells of a material with a given stress law: the
   * operations of CellKernel, with the same symbols; those that sum up energies
   * are in cell_energies.h.
   */
  namespace CellKernels
  {
    /** CellKernel::add_force. */
    template <typename Law>
    void
    add_force(const Law        &law,
              const CellRange  &cells,
              const double      damping_factor,
              const SweepInput &input,
              Vector           &force)
    {
      const double stress_factor = cells.stress_factor;
      with_cells(cells, [&](auto &&cell) {
        for (unsigned int batch = cells.begin; batch < cells.end; ++batch)
          {
            cell.reinit(batch);
            read_filtered(cell, input, damping_factor);
            cell.evaluate(dealii::EvaluationFlags::gradients);
            for (const unsigned int q : cell.quadrature_point_indices())
              cell.submit_symmetric_gradient(
                stress_factor * law.stress(cell.get_symmetric_gradient(q)), q);
            stabilise(cell, law, stress_factor);
            cell.integrate(dealii::EvaluationFlags::gradients);
            add_to_nodes(cell, cells, force);
          }
      });
    }


    /** CellKernel::add_response. */
    template <typename Law>
    void
    add_response(const Law        &law,
                 const CellRange  &cells,
                 const double      damping_factor,
                 const SweepInput &input,
                 Vector           &force,
                 PointHistory     &history)
    {
      const double              stress_factor = cells.stress_factor;
      const PointStep          &step          = input.step;
      const DampedResponse<Law> response(law,
                                         stress_factor,
                                         damping_factor * step.branches);
      const auto               &matrix_free = cells.matrix_free;
      const bool damped = input.damping != SweepInput::Damping::none;
      with_cells(cells, [&](auto &&cell) {
        // damping does not act in cracks
        std::decay_t<decltype(cell)> undamped_cell(matrix_free);
        auto                        &own = damped ? undamped_cell : cell;
        for (unsigned int batch = cells.begin; batch < cells.end; ++batch)
          {
            const Lanes widest = history.bands(batch).widest;
            cell.reinit(batch);
            read_filtered(cell, input, damping_factor);
            cell.evaluate(dealii::EvaluationFlags::gradients);
            bool knows_own = !damped;
            for (const unsigned int q : cell.quadrature_point_indices())
              {
                SymmetricTensor3<Lanes> stress =
                  stress_factor * law.stress(cell.get_symmetric_gradient(q));
                SymmetricTensor3<Lanes> trial = stress;
                if (history.has_static_strains())
                  trial +=
                    law.stress(response.elastic_offset(batch, q, history));
                const bool is_active = history.is_active(batch, q);
                Lanes      ratio     = 0.;
                if (!is_active || history.lanes_are_alone())
                  ratio = law.yield_ratio(trial, widest);
                if (is_active || any_above(ratio, 1.))
                  {
                    if (!knows_own)
                      {
                        own.reinit(batch);
                        own.gather_evaluate(input.displacement,
                                            dealii::EvaluationFlags::gradients);
                        knows_own = true;
                      }
                    stress = response.advance(
                      stress,
                      ratio,
                      cell.get_symmetric_gradient(q),
                      own.get_symmetric_gradient(q),
                      batch,
                      q,
                      matrix_free.n_active_entries_per_cell_batch(batch),
                      cell.JxW(q),
                      step,
                      history);
                  }
                cell.submit_symmetric_gradient(stress, q);
              }
            stabilise(cell, law, stress_factor);
            cell.integrate(dealii::EvaluationFlags::gradients);
            add_to_nodes(cell, cells, force);
          }
      });
    }


    /** CellKernel::set_thermal_strain. */
    inline void
    set_thermal_strain(const CellRange &cells,
                       const double     expansion,
                       PointHistory    &history,
                       const Vector    &temperature)
    {
      with_cells(cells, [&](auto &&cell) {
        for (unsigned int batch = cells.begin; batch < cells.end; ++batch)
          {
            cell.reinit(batch);
            cell.gather_evaluate(temperature, dealii::EvaluationFlags::values);
            for (const unsigned int q : cell.quadrature_point_indices())
              for (unsigned int d = 0; d < 3; ++d)
                history.strain_offset(batch, q)[d][d] =
                  -expansion * cell.get_value(q)[d];
          }
      });
    }


    /** CellKernel::hand_over. */
    template <typename Law>
    void
    hand_over(const Law       &law,
              const Law       &static_law,
              const CellRange &cells,
              const double     static_factor,
              PointHistory    &history)
    {
      const DampedResponse<Law> response(law, 1.);
      for (unsigned int batch = cells.begin; batch < cells.end; ++batch)
        for (unsigned int q = 0; q < history.n_points(); ++q)
          if (history.is_active(batch, q))
            response.hand_over(static_law, static_factor, batch, q, history);
    }


    /** CellKernel::set_static_state. */
    template <typename Law>
    void
    set_static_state(const Law       &law,
                     const CellRange &cells,
                     const double     static_factor,
                     const double     expansion,
                     PointHistory    &history,
                     const Vector    &displacement,
                     const Vector    &temperature)
    {
      const DampedResponse<Law> response(law, cells.stress_factor);
      with_cells(cells, [&](auto &&cell) {
        std::decay_t<decltype(cell)> warmth(cells.matrix_free);
        for (unsigned int batch = cells.begin; batch < cells.end; ++batch)
          {
            cell.reinit(batch);
            cell.gather_evaluate(displacement,
                                 dealii::EvaluationFlags::gradients);
            warmth.reinit(batch);
            warmth.gather_evaluate(temperature,
                                   dealii::EvaluationFlags::values);
            for (const unsigned int q : cell.quadrature_point_indices())
              response.set_static_state(cell.get_symmetric_gradient(q),
                                        warmth.get_value(q),
                                        static_factor,
                                        expansion,
                                        batch,
                                        q,
                                        history);
          }
      });
    }


    /** CellKernel::add_thermal_force. */
    template <typename Law>
    void
    add_thermal_force(const Law       &law,
                      const CellRange &cells,
                      const double     expansion,
                      Vector          &force,
                      const Vector    &temperature)
    {
      const double stress_factor = cells.stress_factor;
      with_cells(cells, [&](auto &&cell) {
        for (unsigned int batch = cells.begin; batch < cells.end; ++batch)
          {
            cell.reinit(batch);
            cell.gather_evaluate(temperature, dealii::EvaluationFlags::values);
            for (const unsigned int q : cell.quadrature_point_indices())
              {
                SymmetricTensor3<Lanes> strain;
                for (unsigned int d = 0; d < 3; ++d)
                  strain[d][d] = expansion * cell.get_value(q)[d];
                cell.submit_symmetric_gradient(stress_factor *
                                                 law.stress(strain),
                                               q);
              }
            if constexpr (is_one_point<decltype(cell)>)
              cell.expand(expansion);
            stabilise(cell, law, stress_factor);
            cell.integrate_scatter(dealii::EvaluationFlags::gradients, force);
          }
      });
    }


    /** CellKernel::element_eigenvalues, by power iteration, which 30 products
     *  bring within one or two per cent. */
    template <typename Law>
    Lanes
    element_eigenvalues(const Law                          &law,
                        const CellRange                    &batch,
                        const dealii::AlignedVector<Lanes> &masses)
    {
      const double stress_factor = batch.stress_factor;
      Lanes        eigenvalue    = 0.;
      with_cells(batch, [&](auto &&cell) {
        cell.reinit(batch.begin);
        const unsigned int           n = masses.size();
        dealii::AlignedVector<Lanes> mode(3 * n);
        for (unsigned int i = 0; i < 3 * n; ++i)
          mode[i] = std::cos(2.3 * i * i + 0.7 * i);
        for (unsigned int iteration = 0; iteration < 30; ++iteration)
          {
            Lanes norm = 0.;
            for (unsigned int i = 0; i < 3 * n; ++i)
              norm += mode[i] * mode[i] * masses[i % n];
            norm = 1. / std::sqrt(norm);
            for (unsigned int i = 0; i < 3 * n; ++i)
              cell.begin_dof_values()[i] = mode[i] *= norm;
            cell.evaluate(dealii::EvaluationFlags::gradients);
            for (const unsigned int q : cell.quadrature_point_indices())
              cell.submit_symmetric_gradient(
                stress_factor * law.stress(cell.get_symmetric_gradient(q)), q);
            stabilise(cell, law, stress_factor);
            cell.integrate(dealii::EvaluationFlags::gradients);
            eigenvalue = 0.;
            for (unsigned int i = 0; i < 3 * n; ++i)
              {
                eigenvalue += mode[i] * cell.begin_dof_values()[i];
                mode[i] = cell.begin_dof_values()[i] / masses[i % n];
              }
          }
      });
      return eigenvalue;
    }
  } // namespace CellKernels
} // namespace Voussoir

#endif
