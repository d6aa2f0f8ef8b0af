#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/text.h>
#include <voussoir/fem/point_weights.h>
#include <voussoir/output/observer.h>

#include <filesystem>
#include <fstream>
#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
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
          reference,
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
      check(const ObservedModel &observed) const override
      {
        find_points(observed);
      }

      void
      prepare(const ObservedModel &observed,
              const double         start_time,
              const bool           restarted) override
      {
        model        = std::make_unique<ObservedModel>(observed);
        setup        = find_points(observed);
        schedule     = Schedule(interval, model->time_step);
        communicator = model->discretization.grid.communicator();
        if (Utilities::MPI::this_mpi_process(communicator) == 0)
          open_file(start_time, restarted);
        largest.assign(setup.points.size(), {{0., 0., 0.}});
      }

      void
      observe(const State &state) override
      {
        if (setup.points.empty())
          return;
        // Velocity and acceleration of step n need the half step after it, so
        // a line is made one step late, from what is kept here.
        auto velocity = setup.values->share(state.velocity);
        if (has_last)
          {
            if (schedule.due(state.step - 1))
              for (unsigned int p = 0; p < setup.points.size(); ++p)
                for (unsigned int d = 0; d < 3; ++d)
                  {
                    buffer.push_back(last_displacement[p][d]);
                    buffer.push_back(0.5 *
                                     (last_velocity[p][d] + velocity[p][d]));
                    buffer.push_back((velocity[p][d] - last_velocity[p][d]) /
                                     model->time_step);
                  }
            if (schedule.due(state.step - 1))
              times.push_back(double(state.step - 1) * model->time_step);
          }
        last_displacement = setup.values->share(state.displacement);
        last_velocity     = std::move(velocity);
        has_last          = true;
        if (times.size() >= 100)
          flush();
      }

      void
      finish(const State &, nlohmann::json &summary) override
      {
        if (setup.points.empty())
          return;
        flush();
        auto &result = summary["histories"];
        for (unsigned int p = 0; p < setup.points.size(); ++p)
          result[setup.points[p].name] = {
            {"largest displacement [m]", largest[p][0]},
            {"largest velocity [m/s]", largest[p][1]},
            {"largest acceleration [m/s2]", largest[p][2]}};
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
      struct Setup
      {
        std::vector<NamedPoint>       points;
        int                           reference = -1; // none
        std::unique_ptr<PointWeights> values;
      };

      Setup
      find_points(const ObservedModel &observed) const
      {
        const std::string place = "\"Points\" in section \"Output/histories\"";
        Setup             result;
        result.points = parse_points(points_text, place);
        std::vector<std::string> names;
        for (const NamedPoint &point : result.points)
          names.push_back(point.name);
        const auto found = std::find(names.begin(), names.end(), reference);
        if (!reference.empty() && found == names.end())
          throw UserError("\"Relative to\" in section \"Output/histories\" "
                          "names the point \"" +
                          reference + "\", which is not among the points" +
                          known_names(reference, names) + ".");
        result.reference = reference.empty() ? -1 : found - names.begin();
        result.values = std::make_unique<PointWeights>(observed.discretization,
                                                       result.points,
                                                       place);
        return result;
      }

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
      open_file(const double start_time, const bool restarted)
      {
        const std::string        name = model->folder + "/histories.csv";
        std::vector<std::string> kept;
        if (restarted)
          {
            // lines from the checkpoint's time on come again
            std::ifstream old(name);
            for (std::string line; std::getline(old, line);)
              if (kept.empty() || std::strtod(line.c_str(), nullptr) <
                                    start_time - 0.5 * model->time_step)
                kept.push_back(line);
          }
        file.open(name);
        file << std::setprecision(9);
        if (!kept.empty())
          {
            for (const std::string &line : kept)
              file << line << '\n';
            return;
          }
        const std::array<std::string, 3> units{{"m", "m/s", "m/s2"}};
        file << "time [s]";
        for (const NamedPoint &point : setup.points)
          for (unsigned int d = 0; d < 3; ++d)
            for (unsigned int k = 0; k < 3; ++k)
              if (wanted(k))
                file << ',' << point.name << ' ' << all_quantities()[k] << ' '
                     << "xyz"[d] << " [" << units[k] << ']';
        file << std::endl;
      }

      void
      flush()
      {
        const auto         sums  = sum_over_ranks(buffer, communicator);
        const unsigned int width = 9 * setup.points.size();
        for (unsigned int line = 0; line < times.size(); ++line)
          {
            const auto base     = model->base_motion(times[line]);
            const auto absolute = [&](const unsigned int p,
                                      const unsigned int d,
                                      const unsigned int k) {
              return sums[line * width + 9 * p + 3 * d + k] + base[k][d];
            };
            if (file.is_open())
              file << times[line];
            for (unsigned int p = 0; p < setup.points.size(); ++p)
              {
                std::array<double, 3> squares{{0., 0., 0.}};
                for (unsigned int d = 0; d < 3; ++d)
                  for (unsigned int k = 0; k < 3; ++k)
                    {
                      const double value =
                        absolute(p, d, k) - (setup.reference >= 0 ?
                                               absolute(setup.reference, d, k) :
                                               0.);
                      squares[k] += value * value;
                      if (wanted(k) && file.is_open())
                        file << ',' << value;
                    }
                for (unsigned int k = 0; k < 3; ++k)
                  largest[p][k] =
                    std::max(largest[p][k], std::sqrt(squares[k]));
              }
            if (file.is_open())
              file << '\n';
          }
        if (file.is_open())
          file.flush();
        buffer.clear();
        times.clear();
      }

      std::string points_text, reference;
      std::string quantities = "displacement, velocity, acceleration";
      double      interval   = 0.01;

      std::unique_ptr<ObservedModel> model;
      Setup                          setup;
      Schedule                       schedule;
      MPI_Comm                       communicator;
      std::ofstream                  file;

      bool                               has_last = false;
      std::vector<Tensor<1, 3>>          last_displacement, last_velocity;
      std::vector<double>                buffer, times;
      std::vector<std::array<double, 3>> largest;
    };

    const Registry<Observer>::Add<Histories>
      registered("histories",
                 "Motion of named points over time, in histories.csv.");
  } // namespace
} // namespace Voussoir
