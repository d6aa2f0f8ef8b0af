#ifndef voussoir_tests_reflected_shares_h
#define voussoir_tests_reflected_shares_h

#include "histories.h"

namespace Voussoir
{
  /**
   * |R| at each frequency from the pulses that pass the middle of a column.
   * They start at its surface and pass down after 1/2, up after 3/2, and down
   * from the surface after 5/2 passages [s].
   */
  inline std::map<double, double>
  reflected_shares(const std::vector<double> &times,
                   const std::vector<double> &values,
                   const std::vector<double> &frequencies,
                   const double               passage)
  {
    std::map<double, double> result;
    for (const double f : frequencies)
      result[f] =
        std::abs(fourier_sum(times, values, f, passage, 2.5 * passage)) /
        std::abs(fourier_sum(times, values, f, 0., passage));
    return result;
  }
} // namespace Voussoir

#endif
