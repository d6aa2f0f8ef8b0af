#include <voussoir/base/parameter_file.h>
#include <voussoir/output/displacement_since.h>
#include <voussoir/output/point_recorder.h>
#include <voussoir/output/table_observer.h>

#include <bitset>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    struct PointQuantity
    {
      std::string name, unit;
    };
    // quantities of PointMotion, then displacements since later states
    constexpr unsigned int n_point_quantities = 6, n_recorded = 4;
    const std::array<PointQuantity, n_point_quantities> all_quantities{
      {{"displacement", "m"},
       {"velocity", "m/s"},
       {"acceleration", "m/s2"},
       {"filtered acceleration", "m/s2"},
       {since_static_state, "m"},
       {since_grouting, "m"}}};
    using Motion = std::array<Tensor<1, 3>, n_point_quantities>;


    /** Displacement, velocity and acceleration of named points, as columns of
     *  histories.csv. */
    class Histories : public TableObserver
    {
    public:
      Histories()
        : TableObserver("histories.csv", 0.01)
      {}

      void
      declare_parameters(ParameterHandler &prm) override
      {
        recorder.declare_parameters(
          prm,
          "Name of the point whose motion is subtracted from that of the "
          "others, as the headings show; the motion of the named point stays "
          "absolute. Empty for absolute motion.");
        prm.add_parameter("Quantities",
                          quantities,
                          "Columns to write: displacement [m], velocity [m/s], "
                          "acceleration [m/s2], in which pounding of cracks "
                          "and joints shows as single steps, and the same "
                          "below the filter frequency; displacement also since "
                          "the static state or the last grouting of joints.",
                          Patterns::MultipleSelection(
                            "displacement|velocity|acceleration|filtered "
                            "acceleration|" +
                            since_static_state + "|" + since_grouting));
        prm.add_parameter(
          "Filter frequency",
          filter_frequency,
          "Filter frequency of the filtered acceleration, which is the mean "
          "over 0.443 of the period of this frequency: amplitudes at this "
          "frequency are multiplied by 0.71 [Hz]; 0 for the highest that the "
          "mesh carries with eight nodes per wavelength.",
          Patterns::Double(0.));
        declare_interval(prm,
                         "Time between two lines [s]; the largest magnitudes "
                         "in summary.json are those of all steps.");
      }

      double
      record_interval() const override
      {
        return interval;
      }

      void
      check(const ObservedModel &model) const override
      {
        check_grouting(quantities, "Output/histories", model);
        recorder.check(model);
      }

      void
      observe(const State &state) override
      {
        if (recorder.points().empty())
          return;
        recorder.observe(state);
        if (recorder.n_waiting() >= 100)
          flush();
      }

    private:
      void
      prepare() override
      {
        filtered_at =
          filter_frequency > 0. ? filter_frequency : run().carried_frequency;
        recorder.prepare(run(), 0., 0.443 / filtered_at);
        const auto list = split_list(quantities);
        for (unsigned int k = 0; k < n_point_quantities; ++k)
          wanted[k] =
            std::find(list.begin(), list.end(), all_quantities[k].name) !=
            list.end();
        keep("largest",
             largest,
             std::vector<std::array<double, n_point_quantities>>(
               recorder.points().size()));
        keep("time of the largest displacement",
             time_of_largest,
             std::vector<double>(recorder.points().size()));
        keep(
          "window",
          [this] { return recorder.save(); },
          [this](const nlohmann::json &saved) { recorder.load(saved); });
        for (unsigned int k = n_recorded; k < n_point_quantities; ++k)
          {
            origins[k].assign(recorder.points().size(), {});
            if (const Vector *origin =
                  origin_of(all_quantities[k].name, run().initial))
              origins[k] = recorder.displacement(*origin);
          }
        std::vector<std::string> columns;
        for (unsigned int p = 0; p < recorder.points().size(); ++p)
          for (unsigned int d = 0; d < 3; ++d)
            for (unsigned int k = 0; k < n_point_quantities; ++k)
              if (wanted[k])
                columns.push_back(
                  recorder.points()[p].name + ' ' + all_quantities[k].name +
                  ' ' + "xyz"[d] +
                  (is_relative(p) ? " relative to " + reference_name() : "") +
                  " [" + all_quantities[k].unit + ']');
        open_table(columns);
      }

      void
      conclude(const State &state, nlohmann::json &summary) override
      {
        if (recorder.points().empty())
          return;
        if (state.step == 0)
          take_rest(state);
        auto &result = summary["histories"];
        for (unsigned int p = 0; p < recorder.points().size(); ++p)
          {
            auto &point = result[recorder.points()[p].name];
            point["largest displacement [m]"]             = largest[p][0];
            point["time of the largest displacement [s]"] = time_of_largest[p];
            point["largest velocity [m/s]"]               = largest[p][1];
            point["largest acceleration of a single step [m/s2]"] =
              largest[p][2];
            point["largest filtered acceleration [m/s2]"] = largest[p][3];
            point["filtered at [Hz]"]                     = filtered_at;
            for (unsigned int k = n_recorded; k < n_point_quantities; ++k)
              if (wanted[k])
                point["largest " + all_quantities[k].name + " [m]"] =
                  largest[p][k];
            if (is_relative(p))
              point["relative to"] = reference_name();
          }
      }

      /** Whether the motion of a point is written relative to the reference
       *  point, whose own motion is absolute. */
      bool
      is_relative(const unsigned int point) const
      {
        return recorder.reference() >= 0 &&
               static_cast<int>(point) != recorder.reference();
      }

      const std::string &
      reference_name() const
      {
        return recorder.points()[recorder.reference()].name;
      }


      /** Absolute. */
      Motion
      motion_of(const PointRecorder::Line &line, const unsigned int point) const
      {
        const PointMotion &recorded = line.points[point];
        Motion             motion;
        std::copy(recorded.begin(), recorded.end(), motion.begin());
        for (unsigned int k = n_recorded; k < n_point_quantities; ++k)
          motion[k] = motion[0] - origins[k][point];
        return motion;
      }

      void
      flush() override
      {
        for (const auto &line : recorder.take())
          take_line(line);
        table.flush();
      }

      void
      take_line(const PointRecorder::Line &line)
      {
        const int           reference = recorder.reference();
        std::vector<double> values;
        for (unsigned int p = 0; p < line.points.size(); ++p)
          {
            Motion motion = motion_of(line, p);
            for (unsigned int k = 0; k < n_point_quantities; ++k)
              {
                if (is_relative(p))
                  motion[k] -= motion_of(line, reference)[k];
                if (const double amount = motion[k].norm();
                    amount > largest[p][k])
                  {
                    largest[p][k] = amount;
                    if (k == 0)
                      time_of_largest[p] = line.time;
                  }
              }
            for (unsigned int d = 0; d < 3; ++d)
              for (unsigned int k = 0; k < n_point_quantities; ++k)
                if (wanted[k])
                  values.push_back(motion[k][d]);
          }
        if (has_line(line.step))
          table.write(line.time, values);
      }

      /** Writes the static state, the only line of a run without steps. */
      void
      take_rest(const State &state)
      {
        PointRecorder::Line line{0, state.time, {}};
        for (const Tensor<1, 3> &u : recorder.displacement(state.displacement))
          {
            line.points.emplace_back();
            line.points.back()[0] = u;
          }
        take_line(line);
        table.flush();
      }

      std::string quantities =
        "displacement, velocity, acceleration, filtered acceleration";
      double filter_frequency = 0.;

      PointRecorder recorder{"Output/histories", "Relative to"};

      std::bitset<n_point_quantities> wanted;           // of `quantities`
      double                          filtered_at = 0.; // [Hz]

      // of each quantity and point: the displacement from which it counts [m]
      std::array<std::vector<Tensor<1, 3>>, n_point_quantities> origins;

      // of each point: magnitudes of its motion
      std::vector<std::array<double, n_point_quantities>> largest;
      std::vector<double> time_of_largest; // [s]
    };

    const Registry<Observer>::Add<Histories> registered_histories(
      "histories",
      "Motion of named points over time, in histories.csv.");
  } // namespace
} // namespace Voussoir
