#include <voussoir/output/observer.h>

#include <deal.II/base/numbers.h>

#include <cmath>
#include <iomanip>

namespace Voussoir
{
  void
  ObservedModel::warn_of_coarse_sampling(const double       interval,
                                         const std::string &place) const
  {
    if (interval < 1.001 * resolving_interval())
      return;
    // two digits, rounded down
    const double unit =
      std::pow(10., std::floor(std::log10(resolving_interval())) - 1.);
    const double largest =
      unit * std::floor(resolving_interval() / unit * (1. + 1e-9));
    std::ostringstream text;
    text << std::setprecision(2) << place << " is " << interval
         << " s, at which extremes of oscillations at the " << carried_frequency
         << " Hz that the mesh carries are too small by up to "
         << 100. * (1. - std::cos(std::min(dealii::numbers::PI * interval *
                                             carried_frequency,
                                           dealii::numbers::PI_2)))
         << " %; set it to " << largest << " s or less";
    log.warn(text.str());
  }


  void
  Observer::begin(const ObservedRun &run)
  {
    observed = std::make_unique<const ObservedRun>(run);
    kept.clear();
    kept_vectors.clear();
    kept_values.clear();
    prepare();
  }


  void
  Observer::finish(const State &state, nlohmann::json &summary)
  {
    flush();
    conclude(state, summary);
  }


  void
  Observer::keep(const std::string                                 &name,
                 const std::function<nlohmann::json()>             &save,
                 const std::function<void(const nlohmann::json &)> &load)
  {
    kept[name] = {save, load};
  }


  void
  Observer::keep(const std::string &name, Vector &vector)
  {
    vector             = run().solid.discretization.create_vector();
    kept_vectors[name] = &vector;
  }


  void
  Observer::keep(
    const std::function<std::map<std::string, KeyedValues>()> &values)
  {
    kept_values.push_back(values);
  }


  nlohmann::json
  Observer::save()
  {
    flush();
    nlohmann::json saved = nlohmann::json::object();
    for (const auto &[name, item] : kept)
      saved[name] = item.save();
    return saved;
  }


  void
  Observer::load(const nlohmann::json &saved)
  {
    for (const auto &[name, item] : kept)
      item.load(saved.at(name));
  }


  std::map<std::string, Vector *>
  Observer::checkpoint_vectors()
  {
    return kept_vectors;
  }


  std::map<std::string, KeyedValues>
  Observer::checkpoint_values()
  {
    std::map<std::string, KeyedValues> all;
    for (const auto &values : kept_values)
      all.merge(values());
    return all;
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
