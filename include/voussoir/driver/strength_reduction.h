#ifndef voussoir_driver_strength_reduction_h
#define voussoir_driver_strength_reduction_h

#include <voussoir/driver/case.h>

namespace Voussoir
{
  /** Strengths of a case that are above zero and not among those reduced, as
   *  "Entry = value". */
  std::vector<std::string>
  strengths_left(const Case                     &parameters,
                 const std::vector<std::string> &reduced);

  /** A strength divided by a reduction factor; an angle of friction is reduced
   *  by its tangent. Throws UserError if the entry is no strength, or the
   *  factor is not positive. */
  std::string
  reduced_strength(const std::string &entry,
                   const std::string &strength,
                   const std::string &divisor);
} // namespace Voussoir

#endif
