#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/text.h>
#include <voussoir/output/point_recorder.h>

namespace Voussoir
{
  using namespace dealii;

  int
  find_point(const std::string             &name,
             const std::vector<NamedPoint> &points,
             const std::string             &place)
  {
    if (name.empty())
      return -1;
    std::vector<std::string> names;
    for (const NamedPoint &point : points)
      names.push_back(point.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      throw UserError(place + " names the point \"" + name +
                      "\", which is not among the points" +
                      known_names(name, names) + ".");
    return found - names.begin();
  }


  PointRecorder::PointRecorder(const ObservedModel           &model,
                               const std::vector<NamedPoint> &points,
                               const std::string             &place,
                               const double                   interval)
    : model(model)
    , n_points(points.size())
    , values(model.discretization, points, place)
    , schedule(interval, model.time_step)
  {}


  void
  PointRecorder::observe(const State &state)
  {
    auto velocity = values.share(state.velocity);
    if (has_last && schedule.due(state.step - 1))
      {
        for (unsigned int p = 0; p < n_points; ++p)
          for (unsigned int d = 0; d < 3; ++d)
            {
              shares.push_back(last_displacement[p][d]);
              shares.push_back(0.5 * (last_velocity[p][d] + velocity[p][d]));
              shares.push_back((velocity[p][d] - last_velocity[p][d]) /
                               model.time_step);
            }
        times.push_back(double(state.step - 1) * model.time_step);
      }
    last_displacement = values.share(state.displacement);
    last_velocity     = std::move(velocity);
    has_last          = true;
  }


  std::size_t
  PointRecorder::n_waiting() const
  {
    return times.size();
  }


  std::vector<PointRecorder::Line>
  PointRecorder::take()
  {
    const auto sums =
      sum_over_ranks(shares, model.discretization.grid.communicator());
    std::vector<Line> lines;
    auto              value = sums.begin();
    for (const double time : times)
      {
        lines.push_back({time, std::vector<PointMotion>(n_points)});
        const auto base = model.base_motion(time);
        for (PointMotion &motion : lines.back().points)
          for (unsigned int d = 0; d < 3; ++d)
            for (unsigned int k = 0; k < 3; ++k)
              motion[k][d] = *value++ + base[k][d];
      }
    shares.clear();
    times.clear();
    return lines;
  }
} // namespace Voussoir
