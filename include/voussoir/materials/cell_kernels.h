#ifndef voussoir_materials_cell_kernels_h
#define voussoir_materials_cell_kernels_h

#include <voussoir/fem/cell_kernel.h>
#include <voussoir/fem/one_point_cell.h>
#include <voussoir/materials/damped_response.h>

namespace Voussoir
{
  /**
   * The loops over the cells of a material with a given stress law: the
   * operations of CellKernel, with the same symbols.
   */
  namespace CellKernels
  {
    // degree and number of points are known at run time only: as fast as with
    // template arguments, and one instantiation serves all degrees
    using Evaluation = dealii::FEEvaluation<3, -1, 0, 3, double>;

    template <typename Cell>
    constexpr bool is_one_point =
      std::is_same_v<std::decay_t<Cell>, OnePointCell>;

    /** Calls work(cell) with the kind of these cells. */
    template <typename Work>
    void
    with_cells(const CellRange &cells, const Work &work)
    {
      if (cells.one_point)
        work(OnePointCell(cells.matrix_free));
      else
        work(Evaluation(cells.matrix_free));
    }

    /** Full integration needs no more than the stress at its points. */
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


    /** Zero where the point is not elastic. */
    inline Lanes
    where_elastic(const PointHistory *history,
                  const unsigned int  batch,
                  const unsigned int  q,
                  const Lanes        &value)
    {
      if (history == nullptr || !history->is_active(batch, q))
        return value;
      return dealii::compare_and_apply_mask<dealii::SIMDComparison::equal>(
        history->active_point(batch, q).band, Lanes(0.), value, Lanes(0.));
    }


    /** CellKernel::elastic_energy. */
    template <typename Law>
    ElasticEnergy
    elastic_energy(const Law          &law,
                   const CellRange    &cells,
                   const double        damping_factor,
                   const DampedMotion &motion,
                   PointHistory       *history)
    {
      const auto       &matrix_free   = cells.matrix_free;
      const double      stress_factor = cells.stress_factor;
      const double      dt            = motion.time_step;
      const Damping    &damping       = motion.damping;
      const MaxwellStep maxwell(damping, dt);
      const double      branches = damping.branch_stiffness();
      const double      viscosity =
        damping_factor * damping.stiffness_coefficient + damping.mesh_viscosity;
      ElasticEnergy total(cells.exact_sums);
      const auto    add_up = [&](auto &cell, const auto &reduce) {
        std::decay_t<decltype(cell)> moving(matrix_free); // at v+
        for (unsigned int batch = cells.begin; batch < cells.end; ++batch)
          {
            cell.reinit(batch);
            moving.reinit(batch);
            // x^T K x and x^T K v+
            const auto products = [&](auto &field) {
              std::array<Lanes, 2> sums{{Lanes(0.), Lanes(0.)}};
              for (const unsigned int q : cell.quadrature_point_indices())
                {
                  const auto  strain = field.get_symmetric_gradient(q);
                  const auto  stress = stress_factor * law.stress(strain);
                  const Lanes weight =
                    where_elastic(history, batch, q, cell.JxW(q));
                  sums[0] += weight * (stress * strain);
                  sums[1] +=
                    weight * (stress * moving.get_symmetric_gradient(q));
                }
              if constexpr (is_one_point<decltype(cell)>)
                {
                  stabilise(field, law, stress_factor);
                  sums[0] += field.stabilisation_work(field);
                  sums[1] += field.stabilisation_work(moving);
                }
              return std::array<decltype(reduce(batch, sums[0])), 2>{
                {reduce(batch, sums[0]), reduce(batch, sums[1])}};
            };
            const auto products_of = [&](const Vector &vector) {
              cell.read_dof_values(vector);
              cell.evaluate(dealii::EvaluationFlags::gradients);
              return products(cell);
            };

            // k/2 s (sum w_i : D : w_i / D_i - w : D : w / sum D_i)
            std::vector<SymmetricTensor3<Lanes>> filter(
              history == nullptr || maxwell.gain.empty() ?
                0 :
                cell.quadrature_point_indices().size());
            const auto add_branch = [&](const unsigned int i) {
              for (const unsigned int q : cell.quadrature_point_indices())
                {
                  const auto  strain = cell.get_symmetric_gradient(q);
                  const Lanes energy = 0.5 * stress_factor * damping_factor /
                                       damping.coefficients[i] *
                                       (law.stress(strain) * strain);
                  Lanes &imbalance = history->imbalance(batch, q);
                  imbalance += energy;
                  filter[q] += strain;
                }
            };

            moving.read_dof_values(motion.velocity);
            moving.evaluate(dealii::EvaluationFlags::gradients);
            using Number        = decltype(reduce(batch, Lanes()));
            const auto [uu, uv] = products_of(motion.displacement);
            add_cells(total.strain, cells, batch, Number(0.5 * (uu - dt * uv)));
            if (viscosity > 0.)
              {
                const auto [bb, bv] = products_of(motion.velocity_before);
                add_cells(total.last_loss,
                          cells,
                          batch,
                          Number(0.5 * dt * viscosity * (bb + bv)));
              }
            const Number vv =
              maxwell.gain.empty() ? Number(0.) : products(moving)[0];
            for (unsigned int q = 0; q < filter.size(); ++q)
              history->imbalance(batch, q) = 0.;
            for (unsigned int i = 0; i < maxwell.gain.size(); ++i)
              if (const double a = maxwell.decay[i], b = maxwell.gain[i];
                  b > 0.)
                {
                  const auto [ww, wv] = products_of(motion.memory[i]);
                  const double factor = damping_factor * dt / (2. * b);
                  const Number across = a * ww + b * wv, // w_i^T K w_i+
                    next              = a * across + b * (a * wv + b * vv);
                  if (history != nullptr)
                    add_branch(i);
                  add_cells(total.memory,
                            cells,
                            batch,
                            Number(factor * across));
                  add_cells(total.next_loss,
                            cells,
                            batch,
                            Number(factor * (1. - a) * (next + across)));
                }
            if (branches > 0.)
              for (unsigned int q = 0; q < filter.size(); ++q)
                history->imbalance(batch, q) -=
                  0.5 * stress_factor * damping_factor / branches *
                  (law.stress(filter[q]) * filter[q]);
          }
      };
      with_cells(cells, [&](auto &&cell) {
        with_reduction(cells,
                       [&](const auto &reduce) { add_up(cell, reduce); });
      });
      return total;
    }


    /** CellKernel::inelastic_energy. */
    template <typename Law>
    InelasticEnergy
    inelastic_energy(const Law             &law,
                     const CellRange       &cells,
                     const double           damping_factor,
                     const InelasticMotion &motion,
                     const PointHistory    &history)
    {
      const DampedResponse<Law> response(law,
                                         cells.stress_factor,
                                         damping_factor * motion.branches);
      InelasticEnergy           total(cells.exact_sums);
      with_cells(cells, [&](auto &&cell) {
        std::decay_t<decltype(cell)> cell_static(cells.matrix_free);
        for (unsigned int batch = cells.begin; batch < cells.end; ++batch)
          {
            const auto points = cell.quadrature_point_indices();
            if (std::none_of(points.begin(),
                             points.end(),
                             [&](const unsigned int q) {
                               return history.is_active(batch, q);
                             }))
              continue;
            cell.reinit(batch);
            cell.gather_evaluate(motion.displacement,
                                 dealii::EvaluationFlags::gradients);
            if (motion.has_static_state)
              {
                cell_static.reinit(batch);
                cell_static.gather_evaluate(motion.static_displacement,
                                            dealii::EvaluationFlags::gradients);
              }
            Lanes stored = 0., of_damping = 0.;
            for (const unsigned int q : points)
              if (history.is_active(batch, q))
                {
                  SymmetricTensor3<Lanes> static_strain;
                  if (motion.has_static_state)
                    static_strain = cell_static.get_symmetric_gradient(q);
                  const auto energy =
                    response.energy(cell.get_symmetric_gradient(q),
                                    static_strain,
                                    batch,
                                    q,
                                    history,
                                    motion.static_history);
                  stored += energy.stored * cell.JxW(q);
                  of_damping += energy.of_damping * cell.JxW(q);
                }
            with_reduction(cells, [&](const auto &reduce) {
              add_cells(total.stored, cells, batch, reduce(batch, stored));
              add_cells(total.damping, cells, batch, reduce(batch, of_damping));
            });
          }
      });
      return total;
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


    /** CellKernel::work. */
    template <typename Law>
    double
    work(const Law          &law,
         const CellRange    &cells,
         const Vector       &u,
         const Vector       &v,
         const PointHistory *history)
    {
      const auto  &matrix_free   = cells.matrix_free;
      const double stress_factor = cells.stress_factor;
      double       total         = 0.;
      with_cells(cells, [&](auto &&cell_u) {
        std::decay_t<decltype(cell_u)> cell_v(matrix_free);
        for (unsigned int batch = cells.begin; batch < cells.end; ++batch)
          {
            cell_u.reinit(batch);
            cell_u.read_dof_values(u);
            cell_u.evaluate(dealii::EvaluationFlags::gradients);
            cell_v.reinit(batch);
            cell_v.read_dof_values(v);
            cell_v.evaluate(dealii::EvaluationFlags::gradients);
            Lanes sum = 0.;
            for (const unsigned int q : cell_u.quadrature_point_indices())
              {
                const Lanes part =
                  stress_factor * law.stress(cell_u.get_symmetric_gradient(q)) *
                  cell_v.get_symmetric_gradient(q) * cell_u.JxW(q);
                sum += where_elastic(history, batch, q, part);
              }
            if constexpr (is_one_point<decltype(cell_u)>)
              {
                stabilise(cell_u, law, stress_factor);
                sum += cell_u.stabilisation_work(cell_v);
              }
            total += sum_of_cells(matrix_free, batch, sum);
          }
      });
      return total;
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
