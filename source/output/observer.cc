#include <voussoir/output/observer.h>

#include <deal.II/base/numbers.h>

#include <cmath>
#include <iomanip>

namespace Voussoir
{
  void
  ObservedModel::warn_of_coarse_looks(const double       interval,
                                      const std::string &place) const
  {
    if (interval < 1.001 * resolving_interval())
      return;
    std::ostringstream text;
    text << std::setprecision(2) << place << " is " << interval
         << " s, at which extremes of what oscillates at the "
         << carried_frequency
         << " Hz that the mesh carries come out too small by up to "
         << 100. * (1. - std::cos(std::min(dealii::numbers::PI * interval *
                                             carried_frequency,
                                           dealii::numbers::PI_2)))
         << " %; set it to " << resolving_interval() << " s or less";
    log.warn(text.str());
  }


  Schedule::Schedule(const double interval, const double time_step)
    : steps(std::max(1LL, std::llround(std::min(interval / time_step, 1e15))))
  {}


  bool
  Schedule::due(const unsigned long long step) const
  {
    return step % steps == 0;
  }
} // namespace Voussoir
