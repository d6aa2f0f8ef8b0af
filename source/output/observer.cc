#include <voussoir/output/observer.h>

namespace Voussoir
{
  Schedule::Schedule(const double interval, const double time_step)
    : steps(std::max(1LL, std::llround(std::min(interval / time_step, 1e15))))
  {}


  bool
  Schedule::due(const unsigned long long step) const
  {
    return step % steps == 0;
  }
} // namespace Voussoir
