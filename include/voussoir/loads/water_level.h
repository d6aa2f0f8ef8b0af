#ifndef voussoir_loads_water_level_h
#define voussoir_loads_water_level_h

#include <voussoir/base/log.h>
#include <voussoir/fem/discretization.h>

namespace Voussoir
{
  /**
   * Refuses a level below all faces that should be wet, and warns of a level
   * above all of them, unless the faces are horizontal, as the bed of a
   * reservoir.
   *
   * @param sets    face sets; @p place names their entry in messages
   * @param level   elevation of the surface [m], given by @p entry
   */
  void
  check_level(const Discretization           &discretization,
              const std::vector<std::string> &sets,
              const std::string              &place,
              const double                    level,
              const std::string              &entry,
              Log                            &log);
} // namespace Voussoir

#endif
