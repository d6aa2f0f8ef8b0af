#include <voussoir/driver/convergence.h>
#include <voussoir/driver/summary_numbers.h>

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  namespace
  {
    constexpr double safety = 1.25, // factor of Roache, for three sizes
      least_order = 0.5, largest_order = 20.,
                     order_margin = 0.5,  // above that of the method
      round_off                   = 1e-9; // and residuals of solvers


    /** Logarithm of (h3^p - h2^p) / (h2^p - h1^p), which grows with p, from
     *  those of the ratios h3/h2 and h2/h1. */
    double
    log_of_changes(const double order, const double coarse, const double fine)
    {
      return order == 0. ? std::log(coarse / fine) :
                           order * fine + std::log(std::expm1(order * coarse) /
                                                   std::expm1(order * fine));
    }


    /** The order with this ratio of changes, between zero and the largest order
     *  considered. */
    double
    observed_order(const double log_changes,
                   const double coarse,
                   const double fine)
    {
      const auto miss = [&](const double order) {
        return log_of_changes(order, coarse, fine) - log_changes;
      };
      if (miss(0.) >= 0.)
        return 0.;
      if (miss(largest_order) <= 0.)
        return largest_order;
      std::uintmax_t max_iterations = 100;
      const auto     bracket        = boost::math::tools::toms748_solve(
        miss,
        0.,
        largest_order,
        boost::math::tools::eps_tolerance<double>(40),
        max_iterations);
      return 0.5 * (bracket.first + bracket.second);
    }
  } // namespace


  Convergence::Convergence(const ThreeSizes &sizes,
                           const ThreeSizes &values,
                           const double      method_order)
  {
    if (!(sizes[0] > sizes[1] && sizes[1] > sizes[2]))
      {
        verdict = "the sizes of the cells and the time step are the same";
        return;
      }
    const double first = values[0] - values[1], last = values[1] - values[2],
                 magnitude = std::max({std::abs(values[0]),
                                       std::abs(values[1]),
                                       std::abs(values[2])});
    if (std::max(std::abs(first), std::abs(last)) <= round_off * magnitude)
      {
        converges = true;
        verdict   = "does not change";
        limit     = values[2];
        band      = 0.;
        return;
      }
    if (first * last < 0.)
      {
        verdict = "oscillates from size to size";
        return;
      }

    const double coarse = std::log(sizes[0] / sizes[1]),
                 fine   = std::log(sizes[1] / sizes[2]);
    order               = last == 0.  ? largest_order :
                          first == 0. ? 0. :
                                        observed_order(std::log(first / last), coarse, fine);
    if (*order <= 0.)
      {
        order.reset();
        verdict = "diverges: its changes do not become smaller";
      }
    else if (*order < least_order)
      verdict =
        "order below " + number_text(least_order) +
        ", as at corners and the ends of cracks: no limit can be determined";
    else if (*order > method_order + order_margin)
      verdict = "order above that of the method, " + number_text(method_order) +
                ": the sizes are too large for a band";
    else
      {
        converges = true;
        verdict   = "converges";
        // an order above the theoretical one is not relied on
        const double error =
          last / std::expm1(std::min(*order, method_order) * fine);
        limit = values[2] - error;
        band  = safety * std::abs(error);
      }
  }
} // namespace Voussoir
