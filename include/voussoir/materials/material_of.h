#ifndef voussoir_materials_material_of_h
#define voussoir_materials_material_of_h

#include <voussoir/fem/one_point_cell.h>
#include <voussoir/materials/material.h>

namespace Voussoir
{
  /**
   * The material that a stress law makes. A new class of materials is one file:
   * a struct with the law,
   *
   *   struct Law : IsotropicElasticity // or with the same members
   *   {
   *     void declare_parameters(ParameterHandler &prm);  // add_parameter()
   *     void check(const std::string &place);            // UserError
   *     template <typename Number>
   *     SymmetricTensor3<Number>
   *     stress(const SymmetricTensor3<Number> &strain) const; // elastic
   *     double young_modulus, poisson_ratio;
   *   };
   *
   * and `const Registry<Material>::Add<MaterialOf<Law>> registered("name",
   * "One sentence.");`.
   *
   * A law with memory has n_history > 0 numbers at each point, which begin at
   * zero and stay there while it is elastic, and
   *
   *     template <typename Number>
   *     Number
   *     load_level(const SymmetricTensor3<Number> &elastic_stress,
   *                const Number                   &element_length) const;
   *     template <typename Number>
   *     PointResponse<Number>
   *     respond(const SymmetricTensor3<Number> &strain,
   *             Number                         *history,
   *             const PointSituation<Number>   &situation) const;
   *     static std::vector<std::string> output_names();
   *     std::vector<double>
   *     outputs(const double *history, const double element_length) const;
   *     std::string remark(const double element_length) const;
   *
   * A point that has been elastic so far stays it without a call of `respond`
   * while the load level, a cheap bound that is one at the elastic limit or
   * before, is below 0.8.
   */
  template <typename Law>
  class MaterialOf : public Material
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override
    {
      Material::declare_parameters(prm);
      law.declare_parameters(prm);
    }

    void
    check(const std::string &place) override
    {
      Material::check(place);
      law.check(place);
    }

    ElasticConstants
    elastic_constants() const override
    {
      return {inertial_density(), law.young_modulus, law.poisson_ratio};
    }

    SymmetricTensor3<double>
    stress(const SymmetricTensor3<double> &strain) const override
    {
      return law.stress(strain);
    }

    PointResponse<double>
    respond(const SymmetricTensor3<double> &strain,
            double                         *history,
            const PointSituation<double>   &situation) const override
    {
      if constexpr (has_memory)
        return law.respond(strain, history, situation);
      else
        return {law.stress(strain), strain, 0.};
    }

    bool
    isotropic() const override
    {
      return Law::isotropic;
    }

    std::vector<std::string>
    output_names() const override
    {
      if constexpr (has_memory)
        return Law::output_names();
      else
        return {};
    }

    std::vector<double>
    outputs(const double *history, const double element_length) const override
    {
      if constexpr (has_memory)
        return law.outputs(history, element_length);
      else
        return {};
    }

    std::string
    remark(const double element_length) const override
    {
      if constexpr (has_memory)
        return law.remark(element_length);
      else
        return {};
    }

    unsigned int
    n_history() const override
    {
      return Law::n_history;
    }

    void
    add_force(const MatrixFree  &matrix_free,
              Vector            &force,
              const Vector      &displacement,
              const Vector      *memory,
              const unsigned int begin,
              const unsigned int end) const override
    {
      with_cells(matrix_free, [&](auto &&cell) {
        for (unsigned int batch = begin; batch < end; ++batch)
          {
            cell.reinit(batch);
            cell.read_dof_values(displacement);
            if (memory != nullptr)
              add_memory(cell, *memory);
            cell.evaluate(dealii::EvaluationFlags::gradients);
            for (const unsigned int q : cell.quadrature_point_indices())
              cell.submit_symmetric_gradient(
                stiffness_scale * law.stress(cell.get_symmetric_gradient(q)),
                q);
            stabilise(cell);
            cell.integrate(dealii::EvaluationFlags::gradients);
            cell.distribute_local_to_global(force);
          }
      });
    }

    void
    add_response(const MatrixFree  &matrix_free,
                 Vector            &force,
                 const Vector      &displacement,
                 const Vector      *memory,
                 const Vector      &undamped,
                 const unsigned int begin,
                 const unsigned int end,
                 PointHistory      &history,
                 const double       time_step) const override
    {
      if constexpr (has_memory)
        {
          const bool damped = memory != nullptr || &undamped != &displacement;
          with_cells(matrix_free, [&](auto &&cell) {
            // the law goes by the strain without damping
            std::decay_t<decltype(cell)> undamped_cell(matrix_free);
            auto                        &own = damped ? undamped_cell : cell;
            for (unsigned int batch = begin; batch < end; ++batch)
              {
                const Lanes length = history.element_length(batch);
                cell.reinit(batch);
                cell.read_dof_values(displacement);
                if (memory != nullptr)
                  add_memory(cell, *memory);
                cell.evaluate(dealii::EvaluationFlags::gradients);
                bool knows_own = !damped;
                for (const unsigned int q : cell.quadrature_point_indices())
                  {
                    SymmetricTensor3<Lanes> stress =
                      stiffness_scale *
                      law.stress(cell.get_symmetric_gradient(q));
                    SymmetricTensor3<Lanes> trial = stress;
                    if (history.has_offset)
                      trial += law.stress(history.strain_offset(batch, q));
                    if (history.is_active(batch, q) ||
                        any_above(law.load_level(trial, length), watched))
                      {
                        if (!knows_own)
                          {
                            own.reinit(batch);
                            own.gather_evaluate(
                              undamped, dealii::EvaluationFlags::gradients);
                            knows_own = true;
                          }
                        stress = stress_by_law(
                          cell.get_symmetric_gradient(q),
                          own.get_symmetric_gradient(q),
                          batch,
                          q,
                          matrix_free.n_active_entries_per_cell_batch(batch),
                          cell.JxW(q),
                          time_step,
                          history);
                      }
                    cell.submit_symmetric_gradient(stress, q);
                  }
                stabilise(cell);
                cell.integrate(dealii::EvaluationFlags::gradients);
                cell.distribute_local_to_global(force);
              }
          });
        }
      else
        (void)undamped, (void)history, (void)time_step,
          add_force(matrix_free, force, displacement, memory, begin, end);
    }

    void
    set_offset(const MatrixFree  &matrix_free,
               PointHistory      &history,
               const Vector      &displacement,
               const Vector      &temperature,
               const unsigned int begin,
               const unsigned int end) const override
    {
      with_cells(matrix_free, [&](auto &&cell) {
        std::decay_t<decltype(cell)> warmth(matrix_free);
        for (unsigned int batch = begin; batch < end; ++batch)
          {
            cell.reinit(batch);
            cell.gather_evaluate(displacement,
                                 dealii::EvaluationFlags::gradients);
            warmth.reinit(batch);
            warmth.gather_evaluate(temperature,
                                   dealii::EvaluationFlags::values);
            for (const unsigned int q : cell.quadrature_point_indices())
              {
                const auto strain = cell.get_symmetric_gradient(q);
                auto      &offset = history.strain_offset(batch, q);
                offset            = (static_factor - strain_factor) * strain;
                for (unsigned int d = 0; d < 3; ++d)
                  offset[d][d] -=
                    static_factor * expansion * warmth.get_value(q)[d];
                auto &elastic = history.static_strain(batch, q);
                elastic       = strain;
                if constexpr (has_memory)
                  if (history.is_active(batch, q))
                    elastic -= strain_factor * strain + offset -
                               look_at(strain,
                                       history.values(batch, q),
                                       history,
                                       batch,
                                       q)
                                 .elastic_strain;
              }
          }
      });
    }

    double
    inelastic_energy(const MatrixFree   &matrix_free,
                     const PointHistory &history,
                     const Vector       &displacement,
                     const Vector       &u_static,
                     const unsigned int  begin,
                     const unsigned int  end) const override
    {
      double total = 0.;
      if constexpr (has_memory)
        {
          with_cells(matrix_free, [&](auto &&cell) {
            std::decay_t<decltype(cell)> cell_static(matrix_free);
            for (unsigned int batch = begin; batch < end; ++batch)
              {
                const auto points = cell.quadrature_point_indices();
                if (std::none_of(points.begin(),
                                 points.end(),
                                 [&](const unsigned int q) {
                                   return history.is_active(batch, q);
                                 }))
                  continue;
                cell.reinit(batch);
                cell.gather_evaluate(displacement,
                                     dealii::EvaluationFlags::gradients);
                if (u_static.size() > 0)
                  {
                    cell_static.reinit(batch);
                    cell_static.gather_evaluate(
                      u_static, dealii::EvaluationFlags::gradients);
                  }
                Lanes sum = 0.;
                for (const unsigned int q : points)
                  if (history.is_active(batch, q))
                    {
                      SymmetricTensor3<Lanes> moved =
                        cell.get_symmetric_gradient(q);
                      const auto now = look_at(
                        moved, history.values(batch, q), history, batch, q);
                      Lanes energy = 0.5 * (now.stress * now.elastic_strain);
                      SymmetricTensor3<Lanes> stretched = now.elastic_strain;
                      if (u_static.size() > 0)
                        {
                          const auto strain =
                            cell_static.get_symmetric_gradient(q);
                          const auto at_start =
                            look_at(strain,
                                    history.values_at_start(batch, q),
                                    history,
                                    batch,
                                    q);
                          moved -= strain;
                          energy -= at_start.stress *
                                    (0.5 * at_start.elastic_strain + moved);
                          stretched -= at_start.elastic_strain;
                        }
                      // what the damping model takes off the moduli
                      energy += 0.5 * (stiffness_scale - strain_factor) *
                                history.damping_share(batch, q) *
                                (law.stress(stretched) * stretched);
                      sum += energy * cell.JxW(q);
                    }
                total += sum_of_cells(matrix_free, batch, sum);
              }
          });
        }
      else
        (void)matrix_free, (void)history, (void)displacement, (void)u_static,
          (void)begin, (void)end;
      return total;
    }

    void
    add_thermal_force(const MatrixFree  &matrix_free,
                      Vector            &force,
                      const Vector      &temperature,
                      const unsigned int begin,
                      const unsigned int end) const override
    {
      with_cells(matrix_free, [&](auto &&cell) {
        for (unsigned int batch = begin; batch < end; ++batch)
          {
            cell.reinit(batch);
            cell.gather_evaluate(temperature, dealii::EvaluationFlags::values);
            for (const unsigned int q : cell.quadrature_point_indices())
              {
                SymmetricTensor3<Lanes> strain;
                for (unsigned int d = 0; d < 3; ++d)
                  strain[d][d] = expansion * cell.get_value(q)[d];
                cell.submit_symmetric_gradient(stiffness_scale *
                                                 law.stress(strain),
                                               q);
              }
            if constexpr (is_one_point<decltype(cell)>)
              cell.expand(expansion);
            stabilise(cell);
            cell.integrate_scatter(dealii::EvaluationFlags::gradients, force);
          }
      });
    }

    double
    work(const MatrixFree   &matrix_free,
         const Vector       &u,
         const Vector       &v,
         const unsigned int  begin,
         const unsigned int  end,
         const PointHistory &history,
         const Inelastic     inelastic) const override
    {
      double total = 0.;
      with_cells(matrix_free, [&](auto &&cell_u) {
        std::decay_t<decltype(cell_u)> cell_v(matrix_free);
        for (unsigned int batch = begin; batch < end; ++batch)
          {
            cell_u.reinit(batch);
            cell_u.read_dof_values(u);
            cell_u.evaluate(dealii::EvaluationFlags::gradients);
            auto *other = &cell_u;
            if (&u != &v)
              {
                cell_v.reinit(batch);
                cell_v.read_dof_values(v);
                cell_v.evaluate(dealii::EvaluationFlags::gradients);
                other = &cell_v;
              }
            Lanes sum = 0.;
            for (const unsigned int q : cell_u.quadrature_point_indices())
              {
                Lanes part = stiffness_scale *
                             law.stress(cell_u.get_symmetric_gradient(q)) *
                             other->get_symmetric_gradient(q) * cell_u.JxW(q);
                if (has_memory && history.is_active(batch, q))
                  part *= inelastic == Inelastic::not_at_all ?
                            Lanes(0.) :
                            history.damping_share(batch, q);
                sum += part;
              }
            if constexpr (is_one_point<decltype(cell_u)>)
              {
                stabilise(cell_u);
                sum += cell_u.stabilisation_work(*other);
              }
            total += sum_of_cells(matrix_free, batch, sum);
          }
      });
      return total;
    }

    Lanes
    element_eigenvalues(
      const MatrixFree                   &matrix_free,
      const unsigned int                  batch,
      const dealii::AlignedVector<Lanes> &masses) const override
    {
      // power iteration, which 30 products bring within one or two per cent
      Lanes eigenvalue = 0.;
      with_cells(matrix_free, [&](auto &&cell) {
        cell.reinit(batch);
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
                stiffness_scale * law.stress(cell.get_symmetric_gradient(q)),
                q);
            stabilise(cell);
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

  private:
    // degree and number of points are known at run time only: as fast as with
    // template arguments, and one instantiation serves all degrees
    using Evaluation = dealii::FEEvaluation<3, -1, 0, 3, double>;

    template <typename Cell>
    static constexpr bool is_one_point =
      std::is_same_v<std::decay_t<Cell>, OnePointCell>;

    static constexpr bool has_memory = Law::n_history > 0;

    /** Calls work(cell) with the kind of cells of the discretization. */
    template <typename Work>
    static void
    with_cells(const MatrixFree &matrix_free, const Work &work)
    {
      if (OnePointCell::serves(matrix_free))
        work(OnePointCell(matrix_free));
      else
        work(Evaluation(matrix_free));
    }

    /** Full integration needs no more than the stress at its points. */
    template <typename Cell>
    void
    stabilise(Cell &cell) const
    {
      if constexpr (is_one_point<Cell>)
        cell.submit_stabilisation(stiffness_scale * law.young_modulus,
                                  law.poisson_ratio);
      else
        (void)cell;
    }

    // load level from which the law itself is asked: below one, as damping adds
    // to the stress or takes from it
    static constexpr double watched = 0.8;

    /** Lanes beyond the last cell of a material hold copies. */
    static double
    sum_of_cells(const MatrixFree  &matrix_free,
                 const unsigned int batch,
                 const Lanes       &values)
    {
      double sum = 0.;
      for (unsigned int lane = 0;
           lane < matrix_free.n_active_entries_per_cell_batch(batch);
           ++lane)
        sum += values[lane];
      return sum;
    }

    /**
     * Lets the memory of the points go one step on. The law sees the strain
     * e = m B u + e_0 without the filters w of damping. They act on the elastic
     * strain since the static state e_s by a stress of their own,
     *   b D : [k B w + (k - m) (B u - e_p - e_s)] ,
     * of which damage leaves the share b. The sum is k D : B (u + w) as long as
     * the law is elastic. With b go the energies that these stresses have
     * stored; that of the filters is at least k B w : D : B w / (2 sum D_i) and
     * comes to this for a fast crack, which all filters follow.
     *
     * @param filtered B (u + w)
     * @param own_strain B u
     */
    SymmetricTensor3<Lanes>
    stress_by_law(const SymmetricTensor3<Lanes> &filtered,
                  const SymmetricTensor3<Lanes> &own_strain,
                  const unsigned int             batch,
                  const unsigned int             q,
                  const unsigned int             n_cells,
                  const Lanes                   &weight,
                  const double                   time_step,
                  PointHistory                  &history) const
    {
      SymmetricTensor3<Lanes> strain = strain_factor * own_strain, offset,
                              elastic_static;
      if (history.has_offset)
        {
          offset         = history.strain_offset(batch, q);
          elastic_static = history.static_strain(batch, q);
          strain += offset;
        }
      Lanes     *values = history.values(batch, q);
      const auto response =
        law.respond(strain,
                    values,
                    PointSituation<Lanes>{history.element_length(batch),
                                          time_step});

      const double difference = stiffness_scale - strain_factor;
      const SymmetricTensor3<Lanes> stretch =
        own_strain - (strain - response.elastic_strain) - elastic_static;
      const SymmetricTensor3<Lanes> filter = filtered - own_strain,
                                    filter_stress =
                                      stiffness_scale * law.stress(filter),
                                    stretch_stress =
                                      difference * law.stress(stretch);
      const Lanes before = history.damping_share(batch, q),
                  now    = response.damping_share;
      Lanes lost =
        response.dissipation +
        0.5 * (before + now) * (stretch_stress * response.plastic_increment) +
        0.5 * (before - now) * (stretch_stress * stretch);
      if (filter_stiffness > 0.)
        lost +=
          0.5 * (before - now) * (filter_stress * filter) / filter_stiffness;

      history.damping_share(batch, q) = now;
      for (unsigned int lane = 0; lane < n_cells; ++lane)
        history.dissipated += lost[lane] * weight[lane];
      if (!history.is_active(batch, q))
        for (unsigned int lane = 0; lane < n_cells; ++lane)
          for (unsigned int i = 0; i < Law::n_history; ++i)
            if (values[i][lane] != 0.)
              history.activate(batch, q);
      return response.stress -
             law.stress(offset - difference * elastic_static) +
             now * (filter_stress + stretch_stress);
    }

    /** Response to a strain of the displacement with this memory (null: none
     *  yet), which stays as it is. */
    PointResponse<Lanes>
    look_at(const SymmetricTensor3<Lanes> &strain,
            const Lanes                   *values,
            const PointHistory            &history,
            const unsigned int             batch,
            const unsigned int             q) const
    {
      std::array<Lanes, Law::n_history> copy;
      copy.fill(Lanes(0.));
      if (values != nullptr)
        std::copy(values, values + Law::n_history, copy.begin());
      SymmetricTensor3<Lanes> total = strain_factor * strain;
      if (history.has_offset)
        total += history.strain_offset(batch, q);
      return law.respond(total,
                         copy.data(),
                         PointSituation<Lanes>{history.element_length(batch),
                                               0.});
    }

    template <typename Cell>
    void
    add_memory(Cell &cell, const Vector &memory) const
    {
      std::array<Lanes, 3 * 125> values; // up to degree 4
      const unsigned int         n = cell.dofs_per_cell;
      for (unsigned int i = 0; i < n; ++i)
        values[i] = cell.begin_dof_values()[i];
      cell.read_dof_values(memory);
      for (unsigned int i = 0; i < n; ++i)
        cell.begin_dof_values()[i] =
          values[i] + damping * cell.begin_dof_values()[i];
    }

    Law law;
  };
} // namespace Voussoir

#endif
