#ifndef voussoir_driver_mesh_against_case_h
#define voussoir_driver_mesh_against_case_h

#include <voussoir/base/log.h>
#include <voussoir/driver/case.h>

namespace Voussoir
{
  /**
   * Warns of probable mistakes that do not prevent a run: a mesh in another
   * unit or with another upward axis, an outer side without boundary condition,
   * rock with weight, water whose pressure and whose added mass act on
   * different faces.
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
