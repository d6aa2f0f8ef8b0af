#include <voussoir/analysis/secant_steps.h>

namespace Voussoir
{
  namespace
  {
    constexpr unsigned int max_pairs = 8;
  } // namespace


  void
  SecantSteps::find(Vector        &step,
                    const Vector  &residual,
                    const Inverse &inverse) const
  {
    Vector              left = residual;
    std::vector<double> share(pairs.size());
    for (unsigned int i = pairs.size(); i-- > 0;)
      {
        share[i] = (pairs[i].step * left) / pairs[i].work;
        left.add(-share[i], pairs[i].taken);
      }
    inverse(step, left);
    for (unsigned int i = 0; i < pairs.size(); ++i)
      step.add(share[i] - (pairs[i].taken * step) / pairs[i].work,
               pairs[i].step);
  }


  void
  SecantSteps::add(const Vector &step, const Vector &taken)
  {
    const double work = step * taken;
    if (work <=
        0.) // the material softened, and the inverse would not be positive
      return;
    if (pairs.size() == max_pairs)
      pairs.pop_front();
    pairs.push_back({step, taken, work});
  }


  bool
  SecantSteps::empty() const
  {
    return pairs.empty();
  }


  void
  SecantSteps::clear()
  {
    pairs.clear();
  }
} // namespace Voussoir
