#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/text.h>
#include <voussoir/output/point_recorder.h>

namespace Voussoir
{
  using namespace dealii;

  PointRecorder::PointRecorder(const std::string &section,
                               const std::string &reference_entry)
    : place("\"Points\" in section \"" + section + '"')
    , reference_entry(reference_entry)
    , reference_place('"' + reference_entry + "\" in section \"" + section +
                      '"')
  {}


  void
  PointRecorder::declare_parameters(ParameterHandler  &prm,
                                    const std::string &help_of_reference)
  {
    prm.add_parameter("Points",
                      points_text,
                      "Named points \"name: x y z\" [m], separated by \";\".");
    prm.add_parameter(reference_entry, reference_name, help_of_reference);
  }


  std::pair<std::vector<NamedPoint>, int>
  PointRecorder::parse() const
  {
    const auto points = parse_points(points_text, place);
    if (reference_name.empty())
      return {points, -1};
    std::vector<std::string> names;
    for (const NamedPoint &point : points)
      names.push_back(point.name);
    const auto found = std::find(names.begin(), names.end(), reference_name);
    if (found == names.end())
      throw UserError(reference_place + " names the point \"" + reference_name +
                      "\", which is not among the points" +
                      known_names(reference_name, names) + ".");
    return {points, found - names.begin()};
  }


  std::size_t
  PointRecorder::check(const ObservedModel &model) const
  {
    const auto points = parse().first;
    PointWeights(model.solid.discretization, points, place);
    return points.size();
  }


  void
  PointRecorder::prepare(const ObservedRun &run,
                         const double       interval,
                         const double       window)
  {
    record          = Record();
    record.window   = std::max(1LL, std::llround(window / run.time_step));
    record.run      = std::make_unique<const ObservedRun>(run);
    record.schedule = Schedule(interval, run.time_step);
    std::tie(record.points, record.reference) = parse();
    record.weights = std::make_unique<PointWeights>(run.solid.discretization,
                                                    record.points,
                                                    place);
  }


  const std::vector<NamedPoint> &
  PointRecorder::points() const
  {
    return record.points;
  }


  int
  PointRecorder::reference() const
  {
    return record.reference;
  }


  std::vector<Tensor<1, 3>>
  PointRecorder::displacement(const Vector &displacement) const
  {
    return record.weights->value(displacement);
  }


  void
  PointRecorder::observe(const State &state)
  {
    const double time_step = record.run->time_step;
    // after a restart the last state comes once more
    if (!record.velocities.empty() && !record.has_last)
      record.velocities.pop_back();
    record.velocities.push_back(record.weights->share(state.velocity));
    if (record.velocities.size() > record.window + 1)
      record.velocities.pop_front();
    if (record.has_last && record.schedule.due(state.step - 1))
      {
        const auto &velocities = record.velocities;
        for (unsigned int i = 0; i < velocities.back().size(); ++i)
          for (unsigned int d = 0; d < 3; ++d)
            {
              const double before = velocities.rbegin()[1][i][d],
                           after  = velocities.back()[i][d];
              record.shares.push_back(record.last_displacement[i][d]);
              record.shares.push_back(0.5 * (before + after));
              record.shares.push_back((after - before) / time_step);
              record.shares.push_back(after);
              record.shares.push_back(velocities.size() > record.window ?
                                        velocities.front()[i][d] :
                                        0.);
            }
        record.steps.push_back(state.step - 1);
      }
    record.last_displacement = record.weights->share(state.displacement);
    record.has_last          = true;
  }


  nlohmann::json
  PointRecorder::save() const
  {
    std::vector<double> values;
    for (const auto &velocity : record.velocities)
      for (const Tensor<1, 3> &v : velocity)
        values.insert(values.end(), v.begin_raw(), v.end_raw());
    return sum_over_ranks(values, record.run->solid.grid().communicator());
  }


  void
  PointRecorder::load(const nlohmann::json &saved)
  {
    const std::vector<double> values = saved;
    const std::size_t n = record.weights->n_parts * record.points.size();
    if (n == 0 || values.size() % (3 * n) != 0)
      return;
    // the first rank has the velocities of all points
    const bool mine = Utilities::MPI::this_mpi_process(
                        record.run->solid.grid().communicator()) == 0;
    record.velocities.assign(values.size() / (3 * n),
                             std::vector<Tensor<1, 3>>(n));
    auto value = values.begin();
    for (auto &velocity : record.velocities)
      for (Tensor<1, 3> &v : velocity)
        for (unsigned int d = 0; d < 3; ++d, ++value)
          if (mine)
            v[d] = *value;
  }


  std::size_t
  PointRecorder::n_waiting() const
  {
    return record.steps.size();
  }


  std::vector<PointRecorder::Line>
  PointRecorder::take()
  {
    const auto sums =
      sum_over_ranks(record.shares, record.run->solid.grid().communicator());
    std::vector<Line> lines;
    auto              value = sums.begin();
    for (const unsigned long long step : record.steps)
      {
        const RigidBase &ground    = record.run->base;
        const double     time_step = record.run->time_step,
                     time          = double(step) * time_step,
                     window        = double(record.window) * time_step,
                     end           = time + 0.5 * time_step;
        const PointMotion base{{ground.displacement(time),
                                ground.velocity(time),
                                ground.acceleration(time),
                                (ground.velocity(end) -
                                 ground.velocity(std::max(0., end - window))) /
                                  window}};
        lines.push_back(
          {step, time, std::vector<PointMotion>(record.points.size())});
        for (PointMotion &motion : lines.back().points)
          {
            std::array<std::array<double, 5>, 3> sum_of_parts{};
            for (unsigned int part = 0; part < record.weights->n_parts; ++part)
              for (auto &of_component : sum_of_parts)
                for (double &sum : of_component)
                  sum += *value++;
            for (unsigned int d = 0; d < 3; ++d)
              {
                const auto &[u, v, a, after, before_window] = sum_of_parts[d];
                motion[0][d]                                = u + base[0][d];
                motion[1][d]                                = v + base[1][d];
                motion[2][d]                                = a + base[2][d];
                motion[3][d] = (after - before_window) / window + base[3][d];
              }
          }
      }
    record.shares.clear();
    record.steps.clear();
    return lines;
  }
} // namespace Voussoir
