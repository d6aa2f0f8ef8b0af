#ifndef voussoir_tests_falling_errors_h
#define voussoir_tests_falling_errors_h

#include <cmath>
#include <cstddef>
#include <vector>

namespace Voussoir
{
  /** Whether each error is below 0.4 of that of the mesh before, of twice the
   *  cell size, as errors of second order are. */
  inline bool
  fall(const std::vector<double> &errors)
  {
    for (std::size_t i = 1; i < errors.size(); ++i)
      if (!(std::abs(errors[i]) < 0.4 * std::abs(errors[i - 1])))
        return false;
    return true;
  }
} // namespace Voussoir

#endif
