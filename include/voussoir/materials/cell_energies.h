#ifndef voussoir_materials_cell_energies_h
#define voussoir_materials_cell_energies_h

#include <voussoir/materials/cell_loops.h>
#include <voussoir/materials/damped_response.h>

namespace Voussoir
{
  /** The loops of CellKernel that sum up energies. */
  namespace CellKernels
  {
    /** The value where the point is elastic, else zero. */
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


    /** Cells in single precision have no internal variables. */
    inline Singles
    where_elastic(const PointHistory *,
                  const unsigned int,
                  const unsigned int,
                  const Singles &value)
    {
      return value;
    }


    /** Share of the stabilisation that cracks have left. */
    inline Lanes
    stabilised_share(const PointHistory *history,
                     const unsigned int  batch,
                     const Lanes        &all)
    {
      if (history == nullptr || !history->has_planes())
        return all;
      return all - history->planes_of(batch).released;
    }


    inline Singles
    stabilised_share(const PointHistory *,
                     const unsigned int,
                     const Singles &all)
    {
      return all;
    }


    /** Strains of a batch at its points. */
    template <typename Cell>
    auto
    strains_of(Cell &cell)
    {
      std::vector<std::decay_t<decltype(cell.get_symmetric_gradient(0))>> list;
      list.reserve(cell.quadrature_point_indices().size());
      for (const unsigned int q : cell.quadrature_point_indices())
        list.push_back(cell.get_symmetric_gradient(q));
      return list;
    }


    /** x^T K x and x^T K v of the elastic points of each cell, with x and v of
     *  @p field and @p moving; @p rates are the strains of v. */
    template <typename Law, typename Cell, typename Strain>
    auto
    elastic_products(const Law                 &law,
                     const double               stress_factor,
                     Cell                      &field,
                     Cell                      &moving,
                     const std::vector<Strain> &rates,
                     const PointHistory        *history,
                     const unsigned int         batch)
    {
      using Number = std::decay_t<decltype(field.JxW(0))>;
      std::array<Number, 2> sums{{Number(0.), Number(0.)}};
      for (const unsigned int q : field.quadrature_point_indices())
        {
          const SymmetricTensor3<Number> strain =
            field.get_symmetric_gradient(q);
          const SymmetricTensor3<Number> stress =
            stress_factor * law.stress(strain);
          const Number weight = where_elastic(history, batch, q, field.JxW(q));
          sums[0] += weight * (stress * strain);
          sums[1] += weight * (stress * rates[q]);
        }
      if constexpr (is_one_point<Cell>)
        {
          stabilise(field, law, stress_factor);
          const Number kept = stabilised_share(history, batch, Number(1.));
          sums[0] += kept * field.stabilisation_work(field);
          sums[1] += kept * field.stabilisation_work(moving);
        }
      return sums;
    }


    /** a : D : b of stabilised strains of a batch [J]. */
    template <typename Law, typename Cell>
    Lanes
    stabilised_product(const Law                     &law,
                       const Cell                    &cell,
                       const StabilisedFields<Lanes> &a,
                       const StabilisedFields<Lanes> &b)
    {
      return Cell::work(
        cell.stabilising_stress(a, law.young_modulus, law.poisson_ratio), b);
    }


    /**
     * Energy of the share r of the stabilisation that is released, beside that
     * of the rest [J], for stabilised strains e of the displacement since the
     * static state and e_v of the velocity: less the static energy,
     *   - (r - r_s) s_s : (e - dt/2 e_v + e_s/2) ,
     * and where the crack is closed, with z = e - e_closing,
     *   r k/2 z : D : (z - dt e_v) .
     *
     * @param cell of the batch, for its shape
     */
    template <typename Law, typename Cell>
    Lanes
    energy_of_released(const Law                     &law,
                       const double                   stress_factor,
                       const Cell                    &cell,
                       const StabilisedFields<Lanes> &strain,
                       const StabilisedFields<Lanes> &velocity,
                       const double                   dt,
                       const PointHistory            &history,
                       const unsigned int             batch)
    {
      const auto work = [&](const auto &a, const auto &b) {
        return stabilised_product(law, cell, a, b);
      };
      const PlanesOfBatch    &planes        = history.planes_of(batch);
      StabilisedFields<Lanes> since_closing = strain;
      Lanes                   energy        = 0.;
      if (history.has_static_strains())
        {
          const auto             &at_rest = history.stabilised_static(batch);
          StabilisedFields<Lanes> middle  = strain;
          middle.add(-0.5 * dt, velocity);
          middle.add(0.5, at_rest.elastic);
          energy -= history.released_since_static_state(batch) *
                    work(at_rest.elastic, middle);
          since_closing.add(1., at_rest.strain);
        }
      since_closing.add(-1., planes.at_closing);
      StabilisedFields<Lanes> before = since_closing;
      before.add(-dt, velocity);
      energy +=
        planes.closed * 0.5 * stress_factor * work(since_closing, before);
      return planes.released * energy;
    }


    /** The energy of the elastic points of a run of cells. */
    template <typename Law>
    class ElasticEnergySum
    {
    public:
      ElasticEnergySum(const Law          &law,
                       const CellRange    &cells,
                       const double        damping_factor,
                       const DampedMotion &motion,
                       PointHistory       *history)
        : law(law)
        , cells(cells)
        , damping_factor(damping_factor)
        , motion(motion)
        , maxwell(motion.damping, motion.time_step)
        , history(history)
        , total(cells.exact_sums)
      {}

      /**
       * Adds the energy of a batch, or of two in single precision.
       *
       * @param cell,moving of the batch, for u and for v+
       * @param read   reads a vector into a cell and evaluates its gradients
       * @param reduce makes a number of one number per cell
       */
      template <typename Cell, typename Read, typename Reduce>
      void
      add(const unsigned int batch,
          Cell              &cell,
          Cell              &moving,
          const Read        &read,
          const Reduce      &reduce)
      {
        const double   dt      = motion.time_step;
        const Damping &damping = motion.damping;
        const double   viscosity =
          damping_factor * damping.stiffness_coefficient +
          damping.mesh_viscosity;
        using Number = decltype(reduce(cell.JxW(0)));

        read(moving, motion.velocity);
        const auto rates    = strains_of(moving);
        const auto products = [&](Cell &field) {
          const auto sums = elastic_products(
            law, cells.stress_factor, field, moving, rates, history, batch);
          return std::array<Number, 2>{{reduce(sums[0]), reduce(sums[1])}};
        };
        const auto products_of = [&](const Vector &vector) {
          read(cell, vector);
          return products(cell);
        };

        const auto [uu, uv] = products_of(motion.displacement);
        add_cells(total.strain, cells, batch, Number(0.5 * (uu - dt * uv)));
        if constexpr (std::is_same_v<std::decay_t<decltype(cell.JxW(0))>,
                                     Lanes> &&
                      is_one_point<Cell>)
          if (history != nullptr && history->has_planes() &&
              any_above(history->planes_of(batch).released, 0.))
            add_cells(total.strain,
                      cells,
                      batch,
                      Number(
                        reduce(energy_of_released(law,
                                                  cells.stress_factor,
                                                  cell,
                                                  cell.stabilised_strain(),
                                                  moving.stabilised_strain(),
                                                  dt,
                                                  *history,
                                                  batch))));
        if (viscosity > 0.)
          {
            const auto [bb, bv] = products_of(motion.velocity_before);
            add_cells(total.last_loss,
                      cells,
                      batch,
                      Number(0.5 * dt * viscosity * (bb + bv)));
          }
        if (maxwell.gain.empty())
          return;

        const Number vv = products(moving)[0];
        begin_imbalance(batch, cell);
        for (unsigned int i = 0; i < maxwell.gain.size(); ++i)
          if (const double a = maxwell.decay[i], b = maxwell.gain[i]; b > 0.)
            {
              const auto [ww, wv] = products_of(motion.memory[i]);
              const double factor = damping_factor * dt / (2. * b);
              const Number across = a * ww + b * wv, // w_i^T K w_i+
                next              = a * across + b * (a * wv + b * vv);
              add_to_imbalance(i, batch, cell);
              add_cells(total.memory, cells, batch, Number(factor * across));
              add_cells(total.next_loss,
                        cells,
                        batch,
                        Number(factor * (1. - a) * (next + across)));
            }
        end_imbalance(batch);
      }

      const ElasticEnergy &
      sum() const
      {
        return total;
      }

    private:
      /** The imbalance of the branches at each point,
       *   k/2 s (sum w_i : D : w_i / D_i - w : D : w / sum D_i) ,
       *  is summed up over the branches i with w = sum w_i. */
      template <typename Cell>
      void
      begin_imbalance(const unsigned int batch, Cell &cell)
      {
        if (history == nullptr)
          return;
        filter.assign(cell.quadrature_point_indices().size(),
                      SymmetricTensor3<Lanes>());
        for (unsigned int q = 0; q < filter.size(); ++q)
          history->imbalance(batch, q) = 0.;
      }

      template <typename Cell>
      void
      add_to_imbalance(const unsigned int branch,
                       const unsigned int batch,
                       Cell              &cell)
      {
        // cells in single precision have no internal variables
        if constexpr (std::is_same_v<std::decay_t<decltype(cell.JxW(0))>,
                                     Lanes>)
          for (unsigned int q = 0; q < filter.size(); ++q)
            {
              auto strain = cell.get_symmetric_gradient(q);
              if constexpr (Law::flows)
                if (damping_factor > 0. && history->is_active(batch, q))
                  strain -= 1. / damping_factor *
                            DampedResponse<Law>::filter_of_flow(
                              history->values(batch, q), branch);
              history->imbalance(batch, q) +=
                0.5 * cells.stress_factor * damping_factor /
                motion.damping.coefficients[branch] *
                (law.stress(strain) * strain);
              filter[q] += strain;
            }
      }

      void
      end_imbalance(const unsigned int batch)
      {
        const double branches = motion.damping.branch_stiffness();
        if (branches > 0.)
          for (unsigned int q = 0; q < filter.size(); ++q)
            history->imbalance(batch, q) -= 0.5 * cells.stress_factor *
                                            damping_factor / branches *
                                            (law.stress(filter[q]) * filter[q]);
      }

      const Law                           &law;
      const CellRange                     &cells;
      const double                         damping_factor;
      const DampedMotion                  &motion;
      const MaxwellStep                    maxwell;
      PointHistory                        *history; // null: none
      std::vector<SymmetricTensor3<Lanes>> filter;  // w of the batch
      ElasticEnergy                        total;
    };


    /** CellKernel::elastic_energy. */
    template <typename Law>
    ElasticEnergy
    elastic_energy(const Law          &law,
                   const CellRange    &cells,
                   const double        damping_factor,
                   const DampedMotion &motion,
                   PointHistory       *history)
    {
      const auto           &matrix_free = cells.matrix_free;
      ElasticEnergySum<Law> energy(law, cells, damping_factor, motion, history);
      with_cells(cells, [&](auto &&cell) {
        if (cells.single_precision && history == nullptr)
          {
            SingleCells<decltype(cell)> two(matrix_free), moving(matrix_free);
            const auto read = [](auto &two, const Vector &vector) {
              two.gather_evaluate(vector);
            };
            for (unsigned int batch = cells.begin; batch < cells.end;
                 batch += 2)
              {
                const unsigned int n = std::min(2U, cells.end - batch);
                two.reinit(batch, n);
                moving.reinit(batch, n);
                energy.add(
                  batch, two, moving, read, [&](const Singles &values) {
                    double sum = 0.;
                    for (unsigned int half = 0; half < n; ++half)
                      sum += sum_of_cells(matrix_free,
                                          batch + half,
                                          half_of_singles(values, half));
                    return sum;
                  });
              }
            return;
          }
        std::decay_t<decltype(cell)> moving(matrix_free);
        const auto read = [](auto &cell, const Vector &vector) {
          cell.read_dof_values(vector);
          cell.evaluate(dealii::EvaluationFlags::gradients);
        };
        with_reduction(cells, [&](const auto &reduce) {
          for (unsigned int batch = cells.begin; batch < cells.end; ++batch)
            {
              cell.reinit(batch);
              moving.reinit(batch);
              energy.add(batch, cell, moving, read, [&](const Lanes &values) {
                return reduce(batch, values);
              });
            }
        });
      });
      return energy.sum();
    }


    /** CellKernel::stabilisation_energy. */
    template <typename Law>
    Lanes
    stabilisation_energy(const Law          &law,
                         const CellRange    &batch,
                         const double        damping_factor,
                         const DampedMotion &motion,
                         const PointHistory &history)
    {
      using Cell = TrilinearCells<OnePointShape>;
      Cell         cell(batch.matrix_free), moving(batch.matrix_free);
      const double dt = motion.time_step, k = batch.stress_factor;
      const auto   read = [&](Cell &cell, const Vector &vector) {
        cell.reinit(batch.begin);
        cell.gather_evaluate(vector, dealii::EvaluationFlags::gradients);
      };
      const auto work = [&](const auto &a, const auto &b) {
        return stabilised_product(law, cell, a, b);
      };
      read(moving, motion.velocity);
      read(cell, motion.displacement);
      const StabilisedFields<Lanes> v = moving.stabilised_strain();

      StabilisedFields<Lanes> strain = cell.stabilised_strain();
      if (history.has_static_strains())
        strain.add(-1., history.stabilised_static(batch.begin).strain);
      const Lanes of_released =
        energy_of_released(law, k, cell, strain, v, dt, history, batch.begin);
      StabilisedFields<Lanes> before = strain;
      before.add(-dt, v);
      Lanes energy = 0.5 * k * work(strain, before);

      // of the branches, as in ElasticEnergy
      const MaxwellStep maxwell(motion.damping, dt);
      for (unsigned int i = 0; i < maxwell.gain.size(); ++i)
        if (const double a = maxwell.decay[i], b = maxwell.gain[i]; b > 0.)
          {
            read(cell, motion.memory[i]);
            const StabilisedFields<Lanes> &w = cell.stabilised_strain();
            energy += k * damping_factor * dt / (2. * b) *
                      (a * work(w, w) + b * work(w, v));
          }
      return (1. - history.planes_of(batch.begin).released) * energy +
             of_released;
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
                                         damping_factor,
                                         motion.branches);
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
  } // namespace CellKernels
} // namespace Voussoir

#endif
