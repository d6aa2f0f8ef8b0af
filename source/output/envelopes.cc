#include <voussoir/base/parameter_file.h>
#include <voussoir/materials/principal_stress.h>
#include <voussoir/output/field_writer.h>
#include <voussoir/output/law_stress.h>
#include <voussoir/output/stress_points.h>

#include <deal.II/fe/fe_tools.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Largest and smallest principal stress over the run in the centre of each
     * cell, where stresses of trilinear cells are most accurate.
     */
    class StressEnvelope
    {
    public:
      /** @param sets cell sets to look at; none for all cells. Of a SIMD batch
       *  with a cell in one of them all cells are looked at, and given. */
      StressEnvelope(const ObservedModel            &model,
                     const std::vector<std::string> &sets)
        : model(model)
        , matrix_free(model.discretization.matrix_free)
      {
        const auto &scalar = model.discretization.fe.base_element(0);
        for (const unsigned int j :
             FETools::lexicographic_to_hierarchic_numbering<3>(
               model.discretization.degree))
          {
            shape_values.push_back(scalar.shape_value(j, centre));
            shape_gradients.push_back(scalar.shape_grad(j, centre));
          }
        const bool is_static = model.initial.displacement.size() > 0;
        if (is_static)
          {
            model.initial.displacement.update_ghost_values();
            model.initial.temperature.update_ghost_values();
          }
        Evaluation cells(matrix_free);
        for (unsigned int b = 0; b < matrix_free.n_cell_batches(); ++b)
          if (sets.empty() || any_cell_in(b, sets))
            batches.push_back(make_batch(b, is_static, cells));
        if (is_static)
          {
            model.initial.displacement.zero_out_ghost_values();
            model.initial.temperature.zero_out_ghost_values();
          }
      }

      void
      update(const Vector &displacement)
      {
        displacement.update_ghost_values();
        Evaluation cells(matrix_free);
        for (Batch &batch : batches)
          {
            const auto              total = strain(cells, batch, displacement);
            SymmetricTensor3<Lanes> stress;
            for (unsigned int lane = 0; lane < n_lanes(batch.number); ++lane)
              {
                SymmetricTensor<2, 3> one, initial;
                for (unsigned int c = 0; c < 6; ++c)
                  {
                    one.access_raw_entry(c) = total.access_raw_entry(c)[lane];
                    initial.access_raw_entry(c) =
                      batch.initial_strain.access_raw_entry(c)[lane];
                  }
                one = batch.laws[lane](one, initial, batch.temperature[lane]);
                for (unsigned int c = 0; c < 6; ++c)
                  stress.access_raw_entry(c)[lane] = one.access_raw_entry(c);
              }
            const auto [largest, smallest] =
              largest_and_smallest_principal(stress);
            for (unsigned int lane = 0; lane < n_lanes(batch.number); ++lane)
              {
                auto &[high, low] = batch.extremes[lane];
                high              = std::max(high, largest[lane]);
                low               = std::min(low, smallest[lane]);
              }
          }
        displacement.zero_out_ghost_values();
      }

      /** Visits the extremes of each cell that is looked at [Pa]. */
      void
      for_each_cell(const std::function<void(const Discretization::Cell &,
                                             std::array<double, 2> &)> &visit)
      {
        for (Batch &batch : batches)
          for (unsigned int lane = 0; lane < n_lanes(batch.number); ++lane)
            visit(matrix_free.get_cell_iterator(batch.number, lane),
                  batch.extremes[lane]);
      }

    private:
      using Evaluation = FEEvaluation<3, -1, 0, 3, double>;

      struct Batch
      {
        Batch()
        {
          extremes.fill({{-std::numeric_limits<double>::max(),
                          std::numeric_limits<double>::max()}});
        }

        unsigned int            number = 0;
        Tensor<2, 3, Lanes>     inverse_jacobian;
        SymmetricTensor3<Lanes> initial_strain;
        Lanes                   temperature = 0.; // change [K]
        std::vector<LawStress>  laws;             // of each cell

        // largest and smallest of each cell
        std::array<std::array<double, 2>, Lanes::size()> extremes;
      };

      bool
      any_cell_in(const unsigned int              batch,
                  const std::vector<std::string> &sets) const
      {
        for (unsigned int lane = 0; lane < n_lanes(batch); ++lane)
          for (const std::string &set : sets)
            if (model.discretization.grid.in_cell_set(
                  matrix_free.get_cell_iterator(batch, lane), set))
              return true;
        return false;
      }

      Batch
      make_batch(const unsigned int number,
                 const bool         is_static,
                 Evaluation        &cells) const
      {
        Batch batch;
        batch.number = number;
        for (unsigned int lane = 0; lane < n_lanes(number); ++lane)
          {
            const auto cell = matrix_free.get_cell_iterator(number, lane);
            const Tensor<2, 3> inverse = inverse_jacobian(cell, centre);
            batch.laws.emplace_back(model, cell, centre);
            for (unsigned int i = 0; i < 3; ++i)
              for (unsigned int k = 0; k < 3; ++k)
                batch.inverse_jacobian[i][k][lane] = inverse[i][k];
          }
        if (is_static)
          {
            batch.initial_strain =
              strain(cells, batch, model.initial.displacement);
            cells.read_dof_values(model.initial.temperature);
            for (unsigned int j = 0; j < shape_values.size(); ++j)
              batch.temperature +=
                shape_values[j] * cells.begin_dof_values()[j];
          }
        return batch;
      }

      unsigned int
      n_lanes(const unsigned int batch) const
      {
        return matrix_free.n_active_entries_per_cell_batch(batch);
      }

      SymmetricTensor3<Lanes>
      strain(Evaluation   &cells,
             const Batch  &batch,
             const Vector &displacement) const
      {
        cells.reinit(batch.number);
        cells.read_dof_values(displacement);
        const Lanes        *values = cells.begin_dof_values();
        Tensor<2, 3, Lanes> unit_gradient;
        for (unsigned int d = 0; d < 3; ++d)
          for (unsigned int j = 0; j < shape_gradients.size(); ++j, ++values)
            for (unsigned int k = 0; k < 3; ++k)
              unit_gradient[d][k] += shape_gradients[j][k] * *values;
        return symmetrize(unit_gradient * batch.inverse_jacobian);
      }

      const Point<3>                    centre{0.5, 0.5, 0.5};
      const ObservedModel               model;
      const Discretization::MatrixFree &matrix_free;
      std::vector<double>               shape_values;    // in the centre
      std::vector<Tensor<1, 3>>         shape_gradients; // by unit coordinate
      AlignedVector<Batch>              batches;
    };


    /** Largest motion of each node and stress of each cell over the run. */
    class Envelopes : public Observer
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Interval",
                          interval,
                          "Time between two looks at the motion [s].",
                          Patterns::Double(1e-6));
        prm.add_parameter("Stress interval",
                          stress_interval,
                          "Time between two looks at the principal stresses "
                          "in the centres of the cells [s]; 0 for none.",
                          Patterns::Double(0.));
        prm.add_parameter("Stress in",
                          stress_sets,
                          "Cell sets whose stresses are looked at; empty for "
                          "all cells.");
      }

      void
      check(const ObservedModel &observed) const override
      {
        for (const std::string &set : split_list(stress_sets))
          observed.discretization.grid.check_cell_set(
            set, "\"Stress in\" in section \"Output/envelopes\"");
      }

      void
      prepare(const ObservedModel &observed, const double, const bool) override
      {
        model    = std::make_unique<ObservedModel>(observed);
        schedule = Schedule(interval, model->time_step);
        // the three components of a node hold its three largest amounts
        largest  = model->discretization.create_vector();
        previous = largest;
        stress.reset();
        if (stress_interval > 0.)
          {
            stress_schedule = Schedule(stress_interval, model->time_step);
            stress =
              std::make_unique<StressEnvelope>(*model, split_list(stress_sets));
          }
      }

      void
      observe(const State &state) override
      {
        if (state.step > 0 && schedule.due(state.step))
          update(state);
        // the acceleration needs the velocity of two steps in a row
        if (schedule.due(state.step + 1))
          previous = state.velocity;
        if (stress && stress_schedule.due(state.step))
          stress->update(state.displacement);
      }

      void
      finish(const State &state, nlohmann::json &) override
      {
        dealii::Vector<float>  high, low;
        std::vector<CellField> cell_fields;
        if (stress)
          {
            const auto n =
              model->discretization.grid.triangulation().n_active_cells();
            high.reinit(n);
            low.reinit(n);
            // cells that are not looked at
            std::fill(high.begin(),
                      high.end(),
                      std::numeric_limits<float>::quiet_NaN());
            low = high;
            stress->for_each_cell([&](const auto &cell, const auto &extremes) {
              high[cell->active_cell_index()] = 1e-6 * extremes[0];
              low[cell->active_cell_index()]  = 1e-6 * extremes[1];
            });
            cell_fields = {{&high, "largest_principal_stress_MPa"},
                           {&low, "smallest_principal_stress_MPa"}};
          }
        write_fields(*model,
                     {{&largest,
                       {"largest_displacement_m",
                        "largest_velocity_m_per_s",
                        "largest_acceleration_m_per_s2"}}},
                     nullptr,
                     "envelopes",
                     state.time,
                     cell_fields);
      }

      std::map<std::string, Vector *>
      checkpoint_vectors() override
      {
        return {{"envelope", &largest}, {"envelope velocity", &previous}};
      }

      std::map<std::string, KeyedValues>
      checkpoint_values() override
      {
        if (!stress)
          return {};
        KeyedValues values{2, {}};
        stress->for_each_cell([&](const auto &cell, auto &extremes) {
          values.items.emplace_back(Grid::global_key(cell), extremes.data());
        });
        return {{"principal stress", values}};
      }

    private:
      void
      update(const State &state)
      {
        const auto norm = [](const double *x) {
          return std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        };
        for (unsigned int i = 0; i < largest.locally_owned_size(); i += 3)
          {
            const double *v = state.velocity.begin() + i;
            const double *p = previous.begin() + i;
            const double  a[3]{(v[0] - p[0]) / model->time_step,
                               (v[1] - p[1]) / model->time_step,
                               (v[2] - p[2]) / model->time_step};
            double       *m = largest.begin() + i;
            m[0] = std::max(m[0], norm(state.displacement.begin() + i));
            m[1] = std::max(m[1], norm(v));
            m[2] = std::max(m[2], norm(a));
          }
      }

      double      interval = 0.01, stress_interval = 0.02;
      std::string stress_sets;

      std::unique_ptr<ObservedModel>  model;
      Schedule                        schedule, stress_schedule;
      Vector                          largest, previous;
      std::unique_ptr<StressEnvelope> stress; // null: not wanted
    };

    const Registry<Observer>::Add<Envelopes> registered(
      "envelopes",
      "Largest displacement, velocity and acceleration of each node and "
      "principal stresses of each cell over the run, in envelopes.vtu.");
  } // namespace
} // namespace Voussoir
