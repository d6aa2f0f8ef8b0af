#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/text.h>
#include <voussoir/output/point_recorder.h>
#include <voussoir/output/table.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string place = "\"Points\" in section \"Output/histories\"";
    const std::string reference_place =
      "\"Relative to\" in section \"Output/histories\"";

    /** Displacement, velocity and acceleration of named points, as columns of
     *  histories.csv. */
    class Histories : public Observer
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Points",
                          points_text,
                          "Named points \"name: x y z\" [m], separated by "
                          "\";\".");
        prm.add_parameter(
          "Relative to",
          reference_name,
          "Name of the point whose motion is subtracted; empty for absolute "
          "motion.");
        prm.add_parameter("Quantities",
                          quantities,
                          "What to write: displacement [m], velocity [m/s], "
                          "acceleration [m/s2].",
                          Patterns::MultipleSelection(
                            "displacement|velocity|acceleration"));
        prm.add_parameter("Interval",
                          interval,
                          "Time between two lines [s].",
                          Patterns::Double(1e-6));
      }

      void
      check(const ObservedModel &model) const override
      {
        const auto parsed = parse_points(points_text, place);
        find_point(reference_name, parsed, reference_place);
        PointWeights(model.discretization, parsed, place);
      }

      void
      prepare(const ObservedModel &model,
              const double         start_time,
              const bool           restarted) override
      {
        points    = parse_points(points_text, place);
        reference = find_point(reference_name, points, reference_place);
        recorder =
          std::make_unique<PointRecorder>(model, points, place, interval);
        largest.assign(points.size(), {{0., 0., 0.}});
        std::vector<std::string> columns;
        for (const NamedPoint &point : points)
          for (unsigned int d = 0; d < 3; ++d)
            for (unsigned int k = 0; k < 3; ++k)
              if (wanted(k))
                columns.push_back(
                  point.name + ' ' + all_quantities()[k] + ' ' + "xyz"[d] +
                  " [" + std::array<const char *, 3>{{"m", "m/s", "m/s2"}}[k] +
                  ']');
        table.open(model.discretization.grid.communicator(),
                   model.folder + "/histories.csv",
                   columns,
                   model.time_step,
                   start_time,
                   restarted);
      }

      void
      observe(const State &state) override
      {
        if (points.empty())
          return;
        recorder->observe(state);
        if (recorder->n_waiting() >= 100)
          flush();
      }

      void
      finish(const State &, nlohmann::json &summary) override
      {
        if (points.empty())
          return;
        flush();
        auto &result = summary["histories"];
        for (unsigned int p = 0; p < points.size(); ++p)
          result[points[p].name] = {{"largest displacement [m]", largest[p][0]},
                                    {"largest velocity [m/s]", largest[p][1]},
                                    {"largest acceleration [m/s2]",
                                     largest[p][2]}};
      }

      nlohmann::json
      save() override
      {
        flush();
        return largest;
      }

      void
      load(const nlohmann::json &saved) override
      {
        if (saved.size() == largest.size())
          saved.get_to(largest);
      }

    private:
      static const std::array<std::string, 3> &
      all_quantities()
      {
        static const std::array<std::string, 3> names{
          {"displacement", "velocity", "acceleration"}};
        return names;
      }

      bool
      wanted(const unsigned int quantity) const
      {
        const auto list = split_list(quantities);
        return std::find(list.begin(),
                         list.end(),
                         all_quantities()[quantity]) != list.end();
      }

      void
      flush()
      {
        for (const auto &line : recorder->take())
          {
            std::vector<double> values;
            for (unsigned int p = 0; p < points.size(); ++p)
              {
                PointMotion motion = line.points[p];
                for (unsigned int k = 0; k < 3; ++k)
                  {
                    if (reference >= 0)
                      motion[k] -= line.points[reference][k];
                    largest[p][k] = std::max(largest[p][k], motion[k].norm());
                  }
                for (unsigned int d = 0; d < 3; ++d)
                  for (unsigned int k = 0; k < 3; ++k)
                    if (wanted(k))
                      values.push_back(motion[k][d]);
              }
            table.write(line.time, values);
          }
        table.flush();
      }

      std::string points_text, reference_name;
      std::string quantities = "displacement, velocity, acceleration";
      double      interval   = 0.01;

      std::vector<NamedPoint>            points;
      int                                reference = -1; // none
      std::unique_ptr<PointRecorder>     recorder;
      TimeTable                          table;
      std::vector<std::array<double, 3>> largest;
    };

    const Registry<Observer>::Add<Histories>
      registered("histories",
                 "Motion of named points over time, in histories.csv.");
  } // namespace
} // namespace Voussoir
