#include <voussoir/base/parameter_file.h>
#include <voussoir/materials/cell_kernels.h>
#include <voussoir/materials/principal_stress.h>
#include <voussoir/output/field_writer.h>
#include <voussoir/output/filtered_displacement.h>
#include <voussoir/output/law_stress.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_tools.h>

#include <bitset>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Of a cell: largest and smallest principal stress over the run [Pa], and
     *  when [s]. */
    using StressExtremes = std::array<double, 4>;


    /**
     * Extremes of the principal stresses over the run in each cell, over the
     * points that pictures show: its nodes.
     */
    class StressEnvelope
    {
    public:
      /** @param sets cell sets to sample; none for all cells */
      StressEnvelope(const ObservedRun              &run,
                     const std::vector<std::string> &sets)
        : run(run)
        , matrix_free(run.solid.discretization.matrix_free)
        , points(QTrapezoid<1>(), run.solid.discretization.degree)
        , filtered(run)
      {
        const auto &scalar = run.solid.discretization.fe.base_element(0);
        const auto  order  = FETools::lexicographic_to_hierarchic_numbering<3>(
          run.solid.discretization.degree);
        for (const Point<3> &point : points.get_points())
          {
            shape_values.emplace_back();
            shape_gradients.emplace_back();
            vertex_gradients.emplace_back();
            for (const unsigned int j : order)
              {
                shape_values.back().push_back(scalar.shape_value(j, point));
                shape_gradients.back().push_back(scalar.shape_grad(j, point));
              }
            for (unsigned int v = 0; v < 8; ++v)
              vertex_gradients.back()[v] =
                GeometryInfo<3>::d_linear_shape_function_gradient(point, v);
          }
        const bool is_static = run.initial.displacement.size() > 0;
        if (is_static)
          {
            run.initial.displacement.update_ghost_values();
            run.initial.temperature.update_ghost_values();
          }
        Evaluation              cells(matrix_free);
        const std::vector<bool> tagged = run.solid.grid().tags_in(sets);
        for (unsigned int b = 0; b < matrix_free.n_cell_batches(); ++b)
          {
            const auto watched = lanes_in(b, sets.empty(), tagged);
            if (watched.any())
              batches.push_back(make_batch(b, watched, is_static, cells));
          }
        if (is_static)
          {
            run.initial.displacement.zero_out_ghost_values();
            run.initial.temperature.zero_out_ghost_values();
          }
      }

      void
      update(const State &state)
      {
        filtered.update(state);
        const Vector    *memory = filtered.memory();
        const SweepInput input{state.displacement,
                               filtered.displacement(),
                               memory != nullptr ?
                                 SweepInput::Damping::by_material :
                                 SweepInput::Damping::common,
                               memory};
        Evaluation       cells(matrix_free);
        for (Batch &batch : batches)
          {
            cells.reinit(batch.number);
            CellKernels::read_filtered(cells, input, batch.damping_factor);
            Lanes high, low;
            for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
              {
                high[lane] = batch.extremes[lane][0];
                low[lane]  = batch.extremes[lane][1];
              }
            for (unsigned int p = 0; p < points.size(); ++p)
              {
                const SymmetricTensor3<Lanes> now =
                  batch.laws[p](strain(cells, batch, p));
                const auto [below, above] = principal_bounds(now);
                if (are_within(below, above, low, high))
                  continue;
                const auto [largest, smallest] =
                  largest_and_smallest_principal(now);
                high = std::max(high, largest);
                low  = std::min(low, smallest);
              }
            for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
              {
                StressExtremes &extremes = batch.extremes[lane];
                // a NaN stays
                if (!(high[lane] <= extremes[0]))
                  {
                    extremes[0] = high[lane];
                    extremes[2] = state.time;
                  }
                if (!(low[lane] >= extremes[1]))
                  {
                    extremes[1] = low[lane];
                    extremes[3] = state.time;
                  }
              }
          }
      }

      /** Whether each cell is sampled; all ranks must call this together. */
      double
      share_of_cells() const
      {
        std::size_t n = 0;
        for (const Batch &batch : batches)
          n += batch.watched.count();
        const auto &triangulation = run.solid.grid().triangulation();
        return double(
                 Utilities::MPI::sum(n, triangulation.get_communicator())) /
               double(triangulation.n_global_active_cells());
      }

      /** Visits each cell that is sampled. */
      void
      for_each_cell(const std::function<void(const Discretization::Cell &,
                                             StressExtremes &)> &visit)
      {
        for (Batch &batch : batches)
          for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
            if (batch.watched[lane])
              visit(matrix_free.get_cell_iterator(batch.number, lane),
                    batch.extremes[lane]);
      }

    private:
      using Evaluation = FEEvaluation<3, -1, 0, 3, double>;

      /** Whether neither bound leaves these values in any lane; not if one is a
       *  NaN. */
      static bool
      are_within(const Lanes &below,
                 const Lanes &above,
                 const Lanes &low,
                 const Lanes &high)
      {
        bool within = true;
        for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
          within =
            within && above[lane] <= high[lane] && below[lane] >= low[lane];
        return within;
      }

      using LaneSet = std::bitset<Lanes::size()>;

      struct Batch
      {
        Batch()
        {
          extremes.fill({{-std::numeric_limits<double>::max(),
                          std::numeric_limits<double>::max(),
                          0.,
                          0.}});
        }

        unsigned int                       number         = 0;
        double                             damping_factor = 1.;
        LaneSet                            watched;
        std::array<Tensor<1, 3, Lanes>, 8> vertices;

        std::vector<LawStressLanes> laws; // of each point

        std::array<StressExtremes, Lanes::size()> extremes;
      };

      LaneSet
      lanes_in(const unsigned int       batch,
               const bool               all,
               const std::vector<bool> &tagged) const
      {
        LaneSet found;
        for (unsigned int lane = 0;
             lane < matrix_free.n_active_entries_per_cell_batch(batch);
             ++lane)
          found[lane] =
            all ||
            tagged[matrix_free.get_cell_iterator(batch, lane)->material_id()];
        return found;
      }

      Batch
      make_batch(const unsigned int number,
                 const LaneSet     &watched,
                 const bool         is_static,
                 Evaluation        &cells) const
      {
        Batch batch;
        batch.number  = number;
        batch.watched = watched;
        batch.damping_factor =
          run.solid
            .materials[run.solid.discretization.material_of_batch[number]]
            ->damping_factor();
        batch.laws.resize(points.size());
        for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
          {
            const bool exists =
              lane < matrix_free.n_active_entries_per_cell_batch(number);
            const auto cell =
              matrix_free.get_cell_iterator(number, exists ? lane : 0);
            for (unsigned int v = 0; v < 8; ++v)
              for (unsigned int d = 0; d < 3; ++d)
                batch.vertices[v][d][lane] = cell->vertex(v)[d];
            if (watched[lane])
              for (unsigned int p = 0; p < points.size(); ++p)
                batch.laws[p].set(lane, {run, cell, points.point(p)});
          }
        if (!is_static)
          return batch;
        cells.reinit(number);
        for (unsigned int p = 0; p < points.size(); ++p)
          {
            cells.read_dof_values(run.initial.displacement);
            const SymmetricTensor3<Lanes> initial = strain(cells, batch, p);
            cells.read_dof_values(run.initial.temperature);
            Lanes temperature = 0.;
            for (unsigned int j = 0; j < shape_values[p].size(); ++j)
              temperature += shape_values[p][j] * cells.begin_dof_values()[j];
            batch.laws[p].set_initial(initial, temperature);
          }
        return batch;
      }

      /** Strain at a point from the values that @p cells has read. */
      SymmetricTensor3<Lanes>
      strain(const Evaluation  &cells,
             const Batch       &batch,
             const unsigned int point) const
      {
        Tensor<2, 3, Lanes> jacobian, unit_gradient;
        const Lanes        *values = cells.begin_dof_values();
        if (run.solid.discretization.degree == 1)
          // the edges that meet in the corner
          for (unsigned int k = 0; k < 3; ++k)
            {
              const unsigned int end   = point | (1U << k),
                                 begin = point & ~(1U << k);
              for (unsigned int d = 0; d < 3; ++d)
                {
                  jacobian[d][k] =
                    batch.vertices[end][d] - batch.vertices[begin][d];
                  unit_gradient[d][k] =
                    values[8 * d + end] - values[8 * d + begin];
                }
            }
        else
          {
            for (unsigned int v = 0; v < 8; ++v)
              for (unsigned int d = 0; d < 3; ++d)
                for (unsigned int k = 0; k < 3; ++k)
                  jacobian[d][k] +=
                    vertex_gradients[point][v][k] * batch.vertices[v][d];
            for (unsigned int d = 0; d < 3; ++d)
              for (const Tensor<1, 3> &gradient : shape_gradients[point])
                {
                  for (unsigned int k = 0; k < 3; ++k)
                    unit_gradient[d][k] += gradient[k] * *values;
                  ++values;
                }
          }
        return symmetrize(unit_gradient * invert(jacobian));
      }

      const ObservedRun                 run;
      const Discretization::MatrixFree &matrix_free;
      const QIterated<3>                points;

      // of each point, in the order of an evaluation, by unit coordinate
      std::vector<std::vector<double>>         shape_values;
      std::vector<std::vector<Tensor<1, 3>>>   shape_gradients;
      std::vector<std::array<Tensor<1, 3>, 8>> vertex_gradients;

      FilteredDisplacement filtered;

      AlignedVector<Batch> batches;
    };


    /** The largest tension of the cells of a material, for the summary. */
    class TensionSummary
    {
    public:
      void
      add(const StressExtremes &extremes,
          const Point<3>       &where,
          const double          volume,
          const bool            beside_another)
      {
        if (extremes[0] > most.stress)
          most = {extremes[0], extremes[2], where};
        if (!beside_another)
          away = std::max(away, extremes[0]);
        cells.push_back(extremes[0]);
        cells.push_back(volume);
      }

      /** All ranks must call this together. */
      nlohmann::json
      json(const MPI_Comm communicator) const
      {
        Cell largest = most;
        for (const Cell &one : Utilities::MPI::all_gather(communicator, most))
          if (one.stress > largest.stress)
            largest = one;
        nlohmann::json result{
          {"largest principal stress [MPa]", 1e-6 * largest.stress},
          {"at the time [s]", largest.time},
          {"in the cell at [m]",
           {largest.where[0], largest.where[1], largest.where[2]}},
          {"not exceeded in 95 % of the volume [MPa]",
           1e-6 * percentile(communicator)}};
        const double elsewhere = Utilities::MPI::max(away, communicator);
        if (elsewhere > nothing)
          result["in cells that touch no other material [MPa]"] =
            1e-6 * elsewhere;
        return result;
      }

    private:
      static constexpr double nothing = -std::numeric_limits<double>::max();

      struct Cell
      {
        double   stress = nothing, time = 0.;
        Point<3> where;

        template <class Archive>
        void
        serialize(Archive &archive, const unsigned int)
        {
          archive &stress &time &where;
        }
      };

      /** The least stress of a cell that is exceeded in at most 5 % of the
       *  volume. By bisection, so that no rank stores the cells of all. */
      double
      percentile(const MPI_Comm communicator) const
      {
        const auto volume_above = [&](const double stress) {
          double volume = 0.;
          for (std::size_t i = 0; i < cells.size(); i += 2)
            if (cells[i] > stress)
              volume += cells[i + 1];
          return Utilities::MPI::sum(volume, communicator);
        };
        const double volume = volume_above(nothing);
        double       lower = -nothing, upper = nothing;
        for (std::size_t i = 0; i < cells.size(); i += 2)
          {
            lower = std::min(lower, cells[i]);
            upper = std::max(upper, cells[i]);
          }
        lower                  = Utilities::MPI::min(lower, communicator);
        upper                  = Utilities::MPI::max(upper, communicator);
        constexpr double share = 0.05;
        for (unsigned int i = 0; i < 50 && lower < upper; ++i)
          {
            const double middle = lower + 0.5 * (upper - lower);
            (volume_above(middle) <= share * volume ? upper : lower) = middle;
          }
        double of_cell = nothing;
        for (std::size_t i = 0; i < cells.size(); i += 2)
          if (cells[i] <= upper)
            of_cell = std::max(of_cell, cells[i]);
        return Utilities::MPI::max(of_cell, communicator);
      }

      Cell                most;
      double              away = nothing; // [Pa]
      std::vector<double> cells;          // stress [Pa] and volume [m3] of each
    };


    /** Vertices at which cells of different materials meet. */
    std::vector<bool>
    vertices_between_materials(const Solid &solid)
    {
      const auto               &triangulation = solid.grid().triangulation();
      constexpr unsigned int    none          = numbers::invalid_unsigned_int;
      std::vector<unsigned int> first(triangulation.n_vertices(), none);
      std::vector<bool>         between(triangulation.n_vertices(), false);
      for (const auto &cell :
           solid.discretization.dof_handler.active_cell_iterators())
        if (!cell->is_artificial())
          for (const unsigned int v : cell->vertex_indices())
            {
              const unsigned int material = solid.grid().material(cell);
              unsigned int      &known    = first[cell->vertex_index(v)];
              if (known == none)
                known = material;
              else if (known != material)
                between[cell->vertex_index(v)] = true;
            }
      return between;
    }


    /** Largest motion of each node and stress of each cell over the run. */
    class Envelopes : public Observer
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Interval",
          interval,
          "Duration of the mean acceleration, which leaves out frequencies "
          "above 0.44 over it, and interval of the samples of the "
          "acceleration of a single step [s]. Displacement and velocity are "
          "sampled each twentieth of the shortest period that the mesh "
          "carries with eight nodes per wavelength, if that is shorter.",
          Patterns::Double(1e-6));
        prm.add_parameter("Stress",
                          wants_stress,
                          "Whether to sample the principal stresses at the "
                          "nodes of each cell, the points that pictures show.");
        prm.add_parameter(
          "Stress interval",
          stress_interval,
          "Time between two samples of these [s]; 0 for a "
          "twentieth of the shortest period that the mesh "
          "carries with eight nodes per wavelength, or longer if samples "
          "would cost more than 2 % of the time steps: the fewer cells, the "
          "shorter. summary.json has it.",
          Patterns::Double(0.));
        prm.add_parameter(
          "Stress in",
          stress_sets,
          "Cell sets whose stresses are sampled, such as those of the dam; "
          "empty for all cells.");
      }

      void
      check(const ObservedModel &model) const override
      {
        for (const std::string &set : split_list(stress_sets))
          model.solid.grid().check_cell_set(
            set, "\"Stress in\" in section \"Output/envelopes\"");
      }

      void
      observe(const State &state) override
      {
        const bool has_mean = schedule.due(state.step);
        if (state.step > last_step && (has_mean || samples.due(state.step)))
          evaluate_motion(state);
        if (state.step > last_step && has_mean)
          evaluate_acceleration(state);
        // the acceleration needs the velocity of two steps in a row
        if (schedule.due(state.step + 1))
          previous = state.velocity;
        if (stress && stress_schedule.due(state.step))
          stress->update(state);
      }

    private:
      void
      prepare() override
      {
        schedule = Schedule(interval, run().time_step);
        samples  = Schedule(run().sampling_interval(interval), run().time_step);
        // three numbers per node in the entries of its three components
        keep("envelope", largest);
        keep("envelope accelerations", accelerations);
        keep("envelope velocity", previous);
        keep("envelope velocity of the last look", last_sample);
        keep("last step", last_step, 0);
        stress.reset();
        if (!wants_stress)
          return;
        stress =
          std::make_unique<StressEnvelope>(run(), split_list(stress_sets));
        keep([this] {
          KeyedValues values{4, {}};
          stress->for_each_cell([&](const auto &cell, auto &extremes) {
            values.items.emplace_back(Grid::global_key(cell), extremes.data());
          });
          return std::map<std::string, KeyedValues>{
            {"principal stress", values}};
        });
        looked_at       = stress_interval > 0. ?
                            stress_interval :
                            std::max(run().resolving_interval(),
                               steps_per_look * stress->share_of_cells() *
                                 run().time_step);
        stress_schedule = Schedule(looked_at, run().time_step);
        if (stress_interval > 0.)
          run().warn_of_coarse_sampling(
            stress_interval,
            "\"Stress interval\" in section \"Output/envelopes\"");
      }

      void
      conclude(const State &state, nlohmann::json &summary) override
      {
        std::array<dealii::Vector<float>, 4> values;
        std::vector<CellField>               cell_fields;
        if (stress)
          {
            const auto n = run().solid.grid().triangulation().n_active_cells();
            // cells that are not sampled
            for (auto &field : values)
              {
                field.reinit(n);
                std::fill(field.begin(),
                          field.end(),
                          std::numeric_limits<float>::quiet_NaN());
              }
            stress->for_each_cell([&](const auto &cell, const auto &extremes) {
              for (unsigned int c = 0; c < 4; ++c)
                values[c][cell->active_cell_index()] =
                  (c < 2 ? 1e-6 : 1.) * extremes[c];
            });
            cell_fields = {{&values[0], "largest_principal_stress_MPa"},
                           {&values[1], "smallest_principal_stress_MPa"},
                           {&values[2], "time_of_largest_s"},
                           {&values[3], "time_of_smallest_s"}};
            summarise_stress(summary["envelopes"]);
            summary["looks at the stress of cells"] = {
              {"interval [s]", looked_at},
              {"extremes hold to 1.2 % up to [Hz]", 0.05 / looked_at}};
          }
        write_fields(run(),
                     {{&largest,
                       {"largest_displacement_m",
                        "largest_velocity_m_per_s",
                        "largest_acceleration_m_per_s2"}},
                      {&accelerations,
                       {"largest_acceleration_of_a_single_step_m_per_s2",
                        "time_of_largest_displacement_s",
                        "time_of_largest_acceleration_s"}}},
                     nullptr,
                     "envelopes",
                     state.time,
                     cell_fields);
      }

      void
      summarise_stress(nlohmann::json &summary)
      {
        const auto between = vertices_between_materials(run().solid);
        std::vector<TensionSummary> materials(run().solid.materials.size());
        stress->for_each_cell([&](const auto &cell, const auto &extremes) {
          bool beside = false;
          for (const unsigned int v : cell->vertex_indices())
            beside = beside || between[cell->vertex_index(v)];
          materials[run().solid.grid().material(cell)].add(extremes,
                                                           cell->center(),
                                                           cell->measure(),
                                                           beside);
        });
        for (unsigned int m = 0; m < materials.size(); ++m)
          {
            const auto found =
              materials[m].json(run().solid.grid().communicator());
            if (found.at("largest principal stress [MPa]").get<double>() >
                -1e300)
              {
                summary[run().names.materials[m]] = found;
                check_tension(m, found);
              }
          }
      }

      /** A law without strength has no limit of tension, concrete and rock
       *  have. */
      void
      check_tension(const unsigned int material, const nlohmann::json &found)
      {
        constexpr double strongest = 10.; // [MPa]
        const double     tension =
          found.at("not exceeded in 95 % of the volume [MPa]");
        if (tension > strongest &&
            run().material_memory.of(material) == nullptr)
          run().log.warn("a twentieth of the volume of \"",
                         run().names.materials[material],
                         "\" has more than ",
                         tension,
                         " MPa of tension at some time, which neither concrete "
                         "nor rock resists, but its law has no strength; check "
                         "the units of loads and motion, or choose a law with "
                         "strength");
      }

      static double
      norm(const double *x)
      {
        return std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
      }

      void
      evaluate_motion(const State &state)
      {
        for (unsigned int i = 0; i < largest.locally_owned_size(); i += 3)
          {
            const double displacement = norm(state.displacement.begin() + i);
            double      *m            = largest.begin() + i;
            if (displacement > m[0])
              accelerations.begin()[i + 1] = state.time;
            m[0] = std::max(m[0], displacement);
            m[1] = std::max(m[1], norm(state.velocity.begin() + i));
          }
      }

      void
      evaluate_acceleration(const State &state)
      {
        const double sampled = (state.step - last_step) * run().time_step;
        for (unsigned int i = 0; i < largest.locally_owned_size(); i += 3)
          {
            const double *v    = state.velocity.begin() + i;
            const auto    mean = [&](const double *before, const double time) {
              const double change[3]{v[0] - before[0],
                                     v[1] - before[1],
                                     v[2] - before[2]};
              return norm(change) / time;
            };
            const double acceleration = mean(last_sample.begin() + i, sampled);
            double *m = largest.begin() + i, *a = accelerations.begin() + i;
            if (acceleration > m[2])
              a[2] = state.time;
            m[2] = std::max(m[2], acceleration);
            a[0] = std::max(a[0], mean(previous.begin() + i, run().time_step));
          }
        last_sample = state.velocity;
        last_step   = state.step;
      }

      // a sample of all cells costs about a quarter of a step
      static constexpr double steps_per_look = 12.;

      bool        wants_stress = true;
      double      interval = 0.01, stress_interval = 0.;
      std::string stress_sets;

      Schedule schedule, samples, stress_schedule;
      Vector   largest, accelerations;
      Vector   previous,
        last_sample; // velocities of a step and of a sample before
      unsigned long long              last_step = 0;  // of that sample
      double                          looked_at = 0.; // interval of stress [s]
      std::unique_ptr<StressEnvelope> stress;         // null: not wanted
    };

    const Registry<Observer>::Add<Envelopes> registered(
      "envelopes",
      "Largest displacement, velocity and acceleration of each node and "
      "principal stresses of each cell over the run, in envelopes.vtu.");
  } // namespace
} // namespace Voussoir
