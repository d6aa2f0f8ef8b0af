#include <voussoir/driver/fragility.h>
#include <voussoir/driver/summary_numbers.h>

#include <deal.II/base/symmetric_tensor.h>

#include <boost/math/distributions/normal.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    using boost::math::cdf;
    using boost::math::complement;

    const boost::math::normal normal;


    /** The likelihood of a probability Phi(c0 + c1 (ln x - shift)), which is
     *  concave in c. */
    struct Likelihood
    {
      Likelihood(const std::vector<IntensityLevel> &levels,
                 const double                       shift,
                 const Tensor<1, 2>                &coefficients)
      {
        for (const IntensityLevel &level : levels)
          {
            Tensor<1, 2> direction;
            direction[0]             = 1.;
            direction[1]             = std::log(level.intensity) - shift;
            const double place       = coefficients * direction;
            const double met         = cdf(normal, place),
                         not_met     = cdf(complement(normal, place)),
                         density     = pdf(normal, place);
            const unsigned int n_not = level.n_runs - level.n_met;
            if (level.n_met > 0)
              logarithm += level.n_met * std::log(met);
            if (n_not > 0)
              logarithm += n_not * std::log(not_met);
            if (met * not_met > 0.) // otherwise the level is far in a tail
              {
                const double weight = density / (met * not_met);
                gradient +=
                  weight * (level.n_met - level.n_runs * met) * direction;
                information += level.n_runs * weight * density *
                               symmetrize(outer_product(direction, direction));
              }
          }
      }

      double                logarithm = 0.;
      Tensor<1, 2>          gradient;
      SymmetricTensor<2, 2> information; // of Fisher
    };


    /** The coefficients of the largest likelihood, by Fisher's scoring. */
    Tensor<1, 2>
    most_likely(const std::vector<IntensityLevel> &levels, const double shift)
    {
      Tensor<1, 2> coefficients;
      coefficients[1] = 1.;
      for (unsigned int i = 0; i < 200; ++i)
        {
          const Likelihood   here(levels, shift, coefficients);
          const Tensor<1, 2> step = invert(here.information) * here.gradient;
          if (step.norm() <= 1e-13 * coefficients.norm())
            break;
          double share = 1.;
          while (!(Likelihood(levels, shift, coefficients + share * step)
                     .logarithm >= here.logarithm) &&
                 share > 1e-6)
            share *= 0.5;
          if (share <= 1e-6) // only round-off is left
            break;
          coefficients += share * step;
        }
      return coefficients;
    }
  } // namespace


  FragilityCurve::FragilityCurve(const std::vector<IntensityLevel> &levels,
                                 const double                       confidence)
  {
    constexpr double infinity  = std::numeric_limits<double>::infinity();
    double           least_met = infinity, largest_not = 0., shift = 0.;
    unsigned int     n_runs = 0;
    for (const IntensityLevel &level : levels)
      {
        if (level.n_met > 0)
          least_met = std::min(least_met, level.intensity);
        if (level.n_met < level.n_runs)
          largest_not = std::max(largest_not, level.intensity);
        shift += level.n_runs * std::log(level.intensity);
        n_runs += level.n_runs;
      }
    shift /= n_runs;
    if (least_met == infinity)
      {
        verdict = "no run meets the criterion; go on to larger intensities";
        return;
      }
    if (largest_not == 0.)
      {
        verdict = "all runs meet the criterion; begin at smaller intensities";
        return;
      }
    if (least_met >= largest_not)
      {
        verdict = "the median is within " + number_text(largest_not) + " and " +
                  number_text(least_met) +
                  ", the dispersion is unknown; put more levels or runs "
                  "there";
        return;
      }
    const Tensor<1, 2> found = most_likely(levels, shift);
    if (!(found[1] > 0.))
      {
        verdict = "the criterion is not met more often at larger intensities";
        return;
      }

    verdict                 = "found";
    const double log_median = shift - found[0] / found[1];
    // derivatives of both logarithms by the coefficients
    Tensor<1, 2> of_median, of_dispersion;
    of_median[0]     = -1. / found[1];
    of_median[1]     = found[0] / (found[1] * found[1]);
    of_dispersion[1] = -1. / found[1];
    const SymmetricTensor<2, 2> covariance =
      invert(Likelihood(levels, shift, found).information);
    const double width   = quantile(normal, 0.5 * (1. + confidence));
    const auto   bounded = [&](const double        logarithm,
                             const Tensor<1, 2> &change) {
      const double half = width * std::sqrt(change * (covariance * change));
      return BoundedEstimate{std::exp(logarithm),
                             std::exp(logarithm - half),
                             std::exp(logarithm + half)};
    };
    median     = bounded(log_median, of_median);
    dispersion = bounded(-std::log(found[1]), of_dispersion);
  }


  double
  FragilityCurve::probability(const double intensity) const
  {
    return cdf(normal, std::log(intensity / median->value) / dispersion->value);
  }
} // namespace Voussoir
