#ifndef voussoir_materials_cell_kernels_h
#define voussoir_materials_cell_kernels_h

#include <voussoir/materials/cell_loops.h>
#include <voussoir/materials/damped_response.h>
#include <voussoir/materials/spectral.h>

namespace Voussoir
{
  /**
   * The loops over the cells of a material with a given stress law: the
   * operations of CellKernel, with the same symbols; operations that sum up
   * energies are in cell_energies.h.
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
      const auto   submit_stress = [&](auto &cell) {
        for (const unsigned int q : cell.quadrature_point_indices())
          cell.submit_symmetric_gradient(
            stress_factor * law.stress(cell.get_symmetric_gradient(q)), q);
        stabilise(cell, law, stress_factor);
      };
      with_cells(cells, [&](auto &&cell) {
        if (!cells.single_precision)
          {
            for (unsigned int batch = cells.begin; batch < cells.end; ++batch)
              {
                cell.reinit(batch);
                read_filtered(cell, input, damping_factor);
                cell.evaluate(dealii::EvaluationFlags::gradients);
                submit_stress(cell);
                cell.integrate(dealii::EvaluationFlags::gradients);
                add_to_nodes(cell, cells, force);
              }
            return;
          }
        SingleCells<decltype(cell)> two(cells.matrix_free);
        for (unsigned int batch = cells.begin; batch < cells.end; batch += 2)
          {
            two.reinit(batch, std::min(2U, cells.end - batch));
            evaluate_filtered(two, input, damping_factor);
            submit_stress(two);
            two.integrate();
            two.distribute_local_to_global(force);
          }
      });
    }


    /**
     * Elastic forces of the cells of @p n batches from @p batch on, in single
     * precision. Returns, for each, the largest yield ratio of the points of
     * each cell; 2 for cells that have left the elastic range or have the plane
     * of a crack.
     */
    template <typename Cells, typename Law>
    std::array<Lanes, 2>
    find_elastic_forces(Cells                     &cells,
                        const Law                 &law,
                        const DampedResponse<Law> &response,
                        const double               stress_factor,
                        const double               damping_factor,
                        const unsigned int         batch,
                        const unsigned int         n,
                        const SweepInput          &input,
                        const PointHistory        &history)
    {
      const unsigned int last = batch + n - 1;
      cells.reinit(batch, n);
      evaluate_filtered(cells, input, damping_factor);
      const Singles widest =
        singles_of(history.bands(batch).widest, history.bands(last).widest);
      Singles ratio = 0.f;
      for (const unsigned int q : cells.quadrature_point_indices())
        {
          const SymmetricTensor3<Singles> stress =
            stress_factor * law.stress(cells.get_symmetric_gradient(q));
          cells.submit_symmetric_gradient(stress, q);
          SymmetricTensor3<Singles> trial = stress;
          if (history.has_static_strains())
            trial +=
              law.stress(singles_of(response.elastic_offset(batch, q, history),
                                    response.elastic_offset(last, q, history)));
          ratio = std::max(ratio, law.yield_ratio(trial, widest));
        }
      stabilise(cells, law, stress_factor);
      cells.integrate();

      std::array<Lanes, 2> ratios;
      for (unsigned int half = 0; half < n; ++half)
        {
          ratios[half] =
            half_of_singles(ratio, half) / history.tip_strength(batch + half);
          for (const unsigned int q : cells.quadrature_point_indices())
            if (history.is_active(batch + half, q))
              ratios[half] =
                dealii::compare_and_apply_mask<dealii::SIMDComparison::equal>(
                  history.active_point(batch + half, q).band,
                  Lanes(0.),
                  ratios[half],
                  Lanes(2.));
          if (history.has_planes())
            ratios[half] =
              dealii::compare_and_apply_mask<dealii::SIMDComparison::equal>(
                history.planes_of(batch + half).width,
                Lanes(0.),
                ratios[half],
                Lanes(2.));
        }
      return ratios;
    }


    /** Releases the share of the stabilisation that a crack has taken; where
     *  the crack is closed, this share acts again, without damping. */
    template <typename Cell, typename Law>
    void
    release(Cell               &cell,
            const Cell         &own,
            const Law          &law,
            const double        stress_factor,
            const PointHistory &history,
            const unsigned int  batch)
    {
      const PlanesOfBatch    &planes = history.planes_of(batch);
      const Lanes             closed = stress_factor * planes.closed;
      StabilisedFields<Lanes> kept{};
      kept.add(closed, own.stabilised_strain());
      kept.add(-closed, planes.at_closing);
      if (history.has_static_strains())
        {
          // forces are those beyond the static state
          const auto &at_rest = history.stabilised_static(batch);
          kept.add(stress_factor, at_rest.strain);
          kept.add(-history.released_since_static_state(batch),
                   at_rest.elastic);
        }
      cell.scale_stabilisation(1. - planes.released);
      cell.add_stabilisation(planes.released,
                             kept,
                             law.young_modulus,
                             law.poisson_ratio);
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
                                         damping_factor,
                                         step.branches);
      const auto               &matrix_free = cells.matrix_free;
      const bool damped = input.damping != SweepInput::Damping::none;
      with_cells(cells, [&](auto &&cell) {
        // damping does not act in cracks
        std::decay_t<decltype(cell)> undamped_cell(matrix_free);
        auto                        &own = damped ? undamped_cell : cell;
        const auto evaluate_own          = [&](const unsigned int batch) {
          own.reinit(batch);
          own.gather_evaluate(input.displacement,
                              dealii::EvaluationFlags::gradients);
        };
        const auto find_forces = [&](const unsigned int batch) {
          Lanes       widest       = history.bands(batch).widest;
          const Lanes tip_strength = history.tip_strength(batch);
          if (history.has_planes())
            widest = std::max(widest, history.planes_of(batch).width);
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
                trial += law.stress(response.elastic_offset(batch, q, history));
              const bool is_active = history.is_active(batch, q);
              Lanes      ratio     = 0.;
              if (!is_active || history.lanes_are_alone())
                ratio = law.yield_ratio(trial, widest) / tip_strength;
              if (is_active || any_above(ratio, 1.))
                {
                  if (!knows_own)
                    {
                      evaluate_own(batch);
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
          if constexpr (is_one_point<decltype(cell)>)
            if (history.has_planes() &&
                any_above(history.planes_of(batch).released, 0.))
              {
                if (!knows_own)
                  evaluate_own(batch);
                release(cell, own, law, stress_factor, history, batch);
              }
          cell.integrate(dealii::EvaluationFlags::gradients);
        };
        if (!cells.single_precision)
          {
            for (unsigned int batch = cells.begin; batch < cells.end; ++batch)
              {
                find_forces(batch);
                add_to_nodes(cell, cells, force);
              }
            return;
          }

        // The response of a cell must not depend on the other cells of its
        // batch: cells that are elastic, and not within round-off of their
        // limit, are evaluated in single precision even beside others that are
        // not elastic.
        const Lanes                 limit = 1. - 1e-5;
        SingleCells<decltype(cell)> two(matrix_free);
        for (unsigned int batch = cells.begin; batch < cells.end; batch += 2)
          {
            const unsigned int n          = std::min(2U, cells.end - batch);
            const auto         ratios     = find_elastic_forces(two,
                                                    law,
                                                    response,
                                                    stress_factor,
                                                    damping_factor,
                                                    batch,
                                                    n,
                                                    input,
                                                    history);
            const auto         is_elastic = [&](const unsigned int half) {
              return !any_above(ratios[half], limit[0]);
            };
            if (n == 2 && is_elastic(0) && is_elastic(1))
              two.distribute_local_to_global(force);
            else
              for (unsigned int half = 0; half < n; ++half)
                if (is_elastic(half))
                  two.distribute_half(force, half);
                else
                  {
                    find_forces(batch + half);
                    Lanes *forces = cell.begin_dof_values();
                    for (unsigned int i = 0; i < cell.dofs_per_cell; ++i)
                      forces[i] = dealii::compare_and_apply_mask<
                        dealii::SIMDComparison::less_than_or_equal>(
                        ratios[half], limit, two.force(i, half), forces[i]);
                    cell.distribute_local_to_global(force);
                  }
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
            if constexpr (is_one_point<decltype(cell)>)
              if (history.has_planes())
                {
                  warmth.expand(expansion);
                  auto &at_rest   = history.stabilised_static(batch);
                  at_rest.strain  = cell.stabilised_strain();
                  at_rest.elastic = {};
                  at_rest.elastic.add(static_factor, at_rest.strain);
                  at_rest.elastic.add(-static_factor,
                                      warmth.stabilised_strain());
                }
            for (const unsigned int q : cell.quadrature_point_indices())
              response.set_static_state(cell.get_symmetric_gradient(q),
                                        warmth.get_value(q),
                                        static_factor,
                                        expansion,
                                        batch,
                                        q,
                                        history);
            if (history.has_planes())
              history.take_over_released(batch);
          }
      });
    }


    /** CellKernel::elastic_stress. */
    template <typename Law>
    SplitStress
    elastic_stress(const Law          &law,
                   const CellRange    &batch,
                   const Vector       &displacement,
                   const PointHistory *history)
    {
      TrilinearCells<OnePointShape> cell(batch.matrix_free);
      cell.reinit(batch.begin);
      cell.gather_evaluate(displacement, dealii::EvaluationFlags::gradients);
      SymmetricTensor3<Lanes> strain = cell.get_symmetric_gradient(0);
      if (history != nullptr && history->has_static_strains())
        for (unsigned int q = 0; q < history->n_points(); ++q)
          strain +=
            (1. / history->n_points()) * history->strain_offset(batch.begin, q);
      const SymmetricTensor3<Lanes> stress    = law.stress(strain);
      const auto                    principal = spectrum(stress);
      std::array<Lanes, 3>          tensile;
      for (unsigned int i = 0; i < 3; ++i)
        tensile[i] = std::max(principal.values[i], Lanes(0.));
      return {stress, principal.compose(tensile)};
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


    /** CellKernel::element_eigenvalues, by power iteration; after 30 products
     *  within one or two per cent. */
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
