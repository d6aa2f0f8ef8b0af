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
    PointWeights(model.discretization, points, place);
    return points.size();
  }


  void
  PointRecorder::prepare(const ObservedModel &model, const double interval)
  {
    record          = Record();
    record.model    = std::make_unique<ObservedModel>(model);
    record.schedule = Schedule(interval, model.time_step);
    std::tie(record.points, record.reference) = parse();
    record.weights = std::make_unique<PointWeights>(model.discretization,
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


  void
  PointRecorder::observe(const State &state)
  {
    const double time_step = record.model->time_step;
    auto         velocity  = record.weights->share(state.velocity);
    if (record.has_last && record.schedule.due(state.step - 1))
      {
        for (unsigned int p = 0; p < record.points.size(); ++p)
          for (unsigned int d = 0; d < 3; ++d)
            {
              const double before = record.last_velocity[p][d],
                           after  = velocity[p][d];
              record.shares.push_back(record.last_displacement[p][d]);
              record.shares.push_back(0.5 * (before + after));
              record.shares.push_back((after - before) / time_step);
            }
        record.times.push_back(double(state.step - 1) * time_step);
      }
    record.last_displacement = record.weights->share(state.displacement);
    record.last_velocity     = std::move(velocity);
    record.has_last          = true;
  }


  std::size_t
  PointRecorder::n_waiting() const
  {
    return record.times.size();
  }


  std::vector<PointRecorder::Line>
  PointRecorder::take()
  {
    const auto sums =
      sum_over_ranks(record.shares,
                     record.model->discretization.grid.communicator());
    std::vector<Line> lines;
    auto              value = sums.begin();
    for (const double time : record.times)
      {
        lines.push_back({time, std::vector<PointMotion>(record.points.size())});
        const RigidBase                  &ground = record.model->base;
        const std::array<Tensor<1, 3>, 3> base{{ground.displacement(time),
                                                ground.velocity(time),
                                                ground.acceleration(time)}};
        for (PointMotion &motion : lines.back().points)
          for (unsigned int d = 0; d < 3; ++d)
            for (unsigned int k = 0; k < 3; ++k)
              motion[k][d] = *value++ + base[k][d];
      }
    record.shares.clear();
    record.times.clear();
    return lines;
  }
} // namespace Voussoir
