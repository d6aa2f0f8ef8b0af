#ifndef voussoir_fem_lanczos_h
#define voussoir_fem_lanczos_h

#include <voussoir/fem/discretization.h>

#include <functional>

namespace Voussoir
{
  /**
   * Largest eigenvalue of M^-1 A for a symmetric A, from Lanczos iterations on
   * M^-1/2 A M^-1/2, which approach this end of the spectrum fast and from
   * below. Iterations stop when the value grows no more; if it never does, as
   * after an overflow, throws UserError.
   *
   * @param start        with a part in every mode
   * @param inverse_mass diagonal of M^-1, zero where fixed
   * @param apply        first argument = A times the second
   * @param reproducible whether the result must be the same on any number of
   *   ranks, bit for bit, as far as it depends on sums in this function
   */
  double
  largest_eigenvalue(const Vector &start,
                     const Vector &inverse_mass,
                     const std::function<void(Vector &, const Vector &)> &apply,
                     const bool reproducible = false);
} // namespace Voussoir

#endif
