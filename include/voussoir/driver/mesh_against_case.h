#ifndef voussoir_driver_mesh_against_case_h
#define voussoir_driver_mesh_against_case_h

#include <voussoir/base/log.h>
#include <voussoir/driver/case.h>

namespace Voussoir
{
  /**
   * Warns of what can be computed, but hardly is meant: a mesh in another unit
   * or turned, an outer side that is forgotten, rock that weighs, water that
   * stands on one face and swings with another.
   *
   * @param materials of the cells of @p mesh
   */
  void
  check_mesh_against_case(const Case                      &parameters,
                          const CoarseMesh                &mesh,
                          const InterfaceSurfaces         &surfaces,
                          const std::vector<unsigned int> &materials,
                          Log                             &log);
} // namespace Voussoir

#endif
