#include <voussoir/signals/time_series.h>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  Motion
  integrate(const TimeSeries &acceleration)
  {
    const double               dt = acceleration.time_step;
    const std::vector<double> &a  = acceleration.values;

    Motion motion{dt,
                  a,
                  std::vector<double>(a.size()),
                  std::vector<double>(a.size())};

    std::vector<double> &v = motion.velocity;
    std::vector<double> &d = motion.displacement;
    for (std::size_t i = 1; i < a.size(); ++i)
      {
        v[i] = v[i - 1] + dt / 2. * (a[i - 1] + a[i]);
        d[i] = d[i - 1] + dt * v[i - 1] + dt * dt / 6. * (2. * a[i - 1] + a[i]);
      }
    return motion;
  }


  double
  peak(const std::vector<double> &values)
  {
    double largest = 0;
    for (const double value : values)
      largest = std::max(largest, std::abs(value));
    return largest;
  }


  TimeSeries
  time_window(const TimeSeries &series,
              const double      start,
              const double      duration)
  {
    const std::size_t size    = series.values.size();
    const auto        samples = [&](const double time) -> std::size_t {
      return std::min(std::round(time / series.time_step), 1. * size);
    };
    const std::size_t first = samples(start);
    const std::size_t last =
      duration > 0 ? std::min(first + samples(duration) + 1, size) : size;

    return {series.time_step,
            {series.values.begin() + first, series.values.begin() + last}};
  }
} // namespace Voussoir
