#include <voussoir/base/parameter_file.h>
#include <voussoir/output/point_recorder.h>
#include <voussoir/output/table.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    struct Quantity
    {
      const char *name, *unit;
    };
    const std::array<Quantity, 3> all_quantities{
      {{"displacement", "m"}, {"velocity", "m/s"}, {"acceleration", "m/s2"}}};


    /** Displacement, velocity and acceleration of named points, as columns of
     *  histories.csv. */
    class Histories : public Observer
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        recorder.declare_parameters(
          prm,
          "Name of the point whose motion is subtracted, which the headings "
          "then say; empty for absolute motion.");
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
        recorder.check(model);
      }

      void
      prepare(const ObservedModel &model,
              const double         start_time,
              const bool           restarted) override
      {
        recorder.prepare(model, interval);
        largest.assign(recorder.points().size(), {{0., 0., 0.}});
        const std::string relative =
          recorder.reference() < 0 ?
            "" :
            " relative to " + recorder.points()[recorder.reference()].name;
        std::vector<std::string> columns;
        for (const NamedPoint &point : recorder.points())
          for (unsigned int d = 0; d < 3; ++d)
            for (unsigned int k = 0; k < 3; ++k)
              if (wanted(k))
                columns.push_back(point.name + ' ' + all_quantities[k].name +
                                  ' ' + "xyz"[d] + relative + " [" +
                                  all_quantities[k].unit + ']');
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
        if (recorder.points().empty())
          return;
        recorder.observe(state);
        if (recorder.n_waiting() >= 100)
          flush();
      }

      void
      finish(const State &, nlohmann::json &summary) override
      {
        if (recorder.points().empty())
          return;
        flush();
        auto &result = summary["histories"];
        for (unsigned int p = 0; p < recorder.points().size(); ++p)
          {
            auto &point = result[recorder.points()[p].name];
            point["largest displacement [m]"]    = largest[p][0];
            point["largest velocity [m/s]"]      = largest[p][1];
            point["largest acceleration [m/s2]"] = largest[p][2];
            if (recorder.reference() >= 0)
              point["relative to"] =
                recorder.points()[recorder.reference()].name;
          }
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
      bool
      wanted(const unsigned int quantity) const
      {
        const auto list = split_list(quantities);
        return std::find(list.begin(),
                         list.end(),
                         all_quantities[quantity].name) != list.end();
      }

      void
      flush()
      {
        const int reference = recorder.reference();
        for (const auto &line : recorder.take())
          {
            std::vector<double> values;
            for (unsigned int p = 0; p < line.points.size(); ++p)
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

      std::string quantities = "displacement, velocity, acceleration";
      double      interval   = 0.01;

      PointRecorder recorder{"Output/histories", "Relative to"};
      TimeTable     table;

      // of each point: displacement, velocity, acceleration [m, m/s, m/s2]
      std::vector<std::array<double, 3>> largest;
    };

    const Registry<Observer>::Add<Histories>
      registered("histories",
                 "Motion of named points over time, in histories.csv.");
  } // namespace
} // namespace Voussoir
