#ifndef voussoir_driver_model_checks_h
#define voussoir_driver_model_checks_h

#include <voussoir/base/log.h>
#include <voussoir/driver/case.h>

namespace Voussoir
{
  /** Refuses a part that shares no node with the others, as it was forgotten
   *  when nodes were merged; a body without any support may be meant to move
   *  freely, and is warned of. */
  void
  check_parts(const Case              &parameters,
              const CoarseMesh        &solid,
              const InterfaceSurfaces &surfaces,
              Log                     &log);

  /** Warns where loads and constraints act on the faces of an interface: on one
   *  of its sides only. */
  void
  report_sets_on_interfaces(const Case              &parameters,
                            const CoarseMesh        &solid,
                            const InterfaceSurfaces &surfaces,
                            Log                     &log);

  /** Warns of levels that do not fit each other: the loads and the added mass
   *  of the same water are in separate sections. */
  void
  check_levels(const Case &parameters, Log &log);
} // namespace Voussoir

#endif
