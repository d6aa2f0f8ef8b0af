#include <voussoir/base/box_of_ranks.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/files/tension_file.h>
#include <voussoir/output/field_writer.h>
#include <voussoir/output/tension_summary.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
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
          "Averaging interval of the mean acceleration, whose -3 dB "
          "frequency is 0.44 divided by this interval, and sampling interval "
          "of the acceleration of a single step [s]. Displacement and "
          "velocity are sampled each twentieth of the shortest period that "
          "the mesh carries with eight nodes per wavelength, if that is "
          "shorter.",
          Patterns::Double(1e-6));
        prm.add_parameter("Stress",
                          wants_stress,
                          "Whether to sample the principal stresses at the "
                          "nodes of each cell, the points that pictures show.");
        prm.add_parameter(
          "Stress interval",
          stress_interval,
          "Time between two samples of the stresses [s]; 0 for a twentieth "
          "of the shortest period that the mesh carries with eight nodes per "
          "wavelength, but at least twelve steps times the share of the cells "
          "that are sampled, as a sample of all cells takes up to the time of "
          "a step. summary.json has the interval.",
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
        keep("envelope velocity of the last sample", last_sample);
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
        sampling_interval =
          stress_interval > 0. ?
            stress_interval :
            std::max(run().resolving_interval(),
                     steps_per_sample * stress->share_of_cells() *
                       run().time_step);
        stress_schedule = Schedule(sampling_interval, run().time_step);
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
            write_tension();
            summary["stress samples"] = {{"interval [s]", sampling_interval},
                                         {"extremes hold to 1.2 % up to [Hz]",
                                          0.05 / sampling_interval}};
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

      /** Cells with tension, for "Refine where" of a later run. */
      void
      write_tension()
      {
        const Grid &grid = run().solid.grid();
        BoxOfRanks  box;
        for (const auto &cell : grid.triangulation().active_cell_iterators())
          if (cell->is_locally_owned())
            for (const unsigned int v : cell->vertex_indices())
              box.add(cell->vertex(v));
        box.join(communicator());
        TensionFile tension{run().names.materials, box.lower, box.upper, {}};
        stress->for_each_cell([&](const auto &cell, const auto &extremes) {
          const bool   is_beyond = has_left_elastic_range(cell);
          const double largest =
            is_beyond ? std::numeric_limits<double>::infinity() : extremes[0];
          if (largest > 0.)
            tension.cells.push_back(
              {frame_of([&](const unsigned int v) { return cell->vertex(v); }),
               largest,
               grid.material(cell)});
        });
        const std::string file = tension_file(run().folder);
        run().log.attempted(
          file, ::Voussoir::write_tension(file, tension, communicator()));
      }

      bool
      has_left_elastic_range(const Discretization::Cell &cell) const
      {
        const auto         &solid = run().solid;
        const PointHistory *history =
          run().material_memory.of(solid.grid().material(cell));
        if (history == nullptr)
          return false;
        const auto place = solid.discretization.place_of(cell);
        for (unsigned int q = 0; q < history->n_points(); ++q)
          if (history->band({place.batch, place.lane}, q) > 0.)
            return true;
        return false;
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

      /** Warns of tension above the strength of any concrete or rock in a
       *  material whose law has no strength. */
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
      square(const double *x)
      {
        return x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
      }

      void
      evaluate_motion(const State &state)
      {
        // no roots for nodes below their largest motion, as most are
        for (unsigned int i = 0; i < largest.locally_owned_size(); i += 3)
          {
            double      *m            = largest.begin() + i;
            const double displacement = square(state.displacement.begin() + i),
                         velocity     = square(state.velocity.begin() + i);
            if (displacement > m[0] * m[0] && std::sqrt(displacement) > m[0])
              {
                m[0]                         = std::sqrt(displacement);
                accelerations.begin()[i + 1] = state.time;
              }
            if (velocity > m[1] * m[1])
              m[1] = std::sqrt(velocity);
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
              return std::sqrt(square(change)) / time;
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

      // a sample of all cells takes as long as a step where the cells are
      // elastic (prm/quickstart.prm)
      static constexpr double steps_per_sample = 12.;

      bool        wants_stress = true;
      double      interval = 0.01, stress_interval = 0.;
      std::string stress_sets;

      Schedule schedule, samples, stress_schedule;
      Vector   largest, accelerations;
      Vector   previous,
        last_sample; // velocities of the step and of the sample before
      unsigned long long last_step         = 0;  // of the last sample
      double             sampling_interval = 0.; // of the stress [s]
      std::unique_ptr<StressEnvelope> stress;    // null: not wanted
    };

    const Registry<Observer>::Add<Envelopes> registered_envelopes(
      "envelopes",
      "Largest displacement, velocity and acceleration of each node and "
      "principal stresses of each cell over the run, in envelopes.vtu; cells "
      "with tension for \"Refine where\" of a later run in "
      "largest_tension.h5.");
  } // namespace
} // namespace Voussoir
