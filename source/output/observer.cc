#include <voussoir/output/observer.h>

namespace Voussoir
{
  Schedule::Schedule(const double interval, const double time_step)
    : interval(interval)
    , time_step(time_step)
  {}


  bool
  Schedule::due(const unsigned long long step) const
  {
    // the steps nearest to the multiples of the interval
    const auto tick = [&](const double s) {
      return std::floor(s * time_step / interval + 0.5 * time_step / interval);
    };
    return step == 0 || tick(double(step)) != tick(double(step) - 1.);
  }
} // namespace Voussoir
