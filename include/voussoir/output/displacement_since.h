#ifndef voussoir_output_displacement_since_h
#define voussoir_output_displacement_since_h

#include <voussoir/output/observer.h>

namespace Voussoir
{
  /** Displacements are totals, which begin before the first static stage. These
   *  quantities of observers count them from a later state. */
  inline const std::string since_static_state =
                             "displacement since static state",
                           since_grouting = "displacement since grouting";

  /** Displacement of the state from which this quantity counts [m]; null for
   *  the total displacement. */
  const Vector *
  origin_of(const std::string &quantity, const InitialState &initial);

  /** Refuses to count from the grouting where no interface is grouted.
   *  @param quantities list of an entry "Quantities"
   *  @param section    that it is in */
  void
  check_grouting(const std::string   &quantities,
                 const std::string   &section,
                 const ObservedModel &model);
} // namespace Voussoir

#endif
