#ifndef voussoir_driver_model_checks_h
#define voussoir_driver_model_checks_h

#include <voussoir/base/log.h>
#include <voussoir/driver/case.h>
#include <voussoir/loads/reservoir.h>

namespace Voussoir
{
  /** Refuses a part without support that shares no node with a supported one,
   *  as its nodes were probably not merged. Warns of other separate parts,
   *  which may be meant to move freely. */
  void
  check_parts(const Case              &parameters,
              const CoarseMesh        &solid,
              const InterfaceSurfaces &surfaces,
              Log                     &log);

  /** Warns of boundaries, loads and constraints on the faces of an interface,
   *  as they act on one of its sides only. */
  void
  report_sets_on_interfaces(const Case              &parameters,
                            const CoarseMesh        &solid,
                            const InterfaceSurfaces &surfaces,
                            Log                     &log);

  /** Warns of levels that contradict each other: the loads and the added mass
   *  or the mesh of the same water are in separate sections.
   *  @param reservoir of compressible water, or null */
  void
  check_levels(const Case &parameters, const Reservoir *reservoir, Log &log);
} // namespace Voussoir

#endif
