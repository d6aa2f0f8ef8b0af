#ifndef voussoir_mesh_mesh_report_h
#define voussoir_mesh_mesh_report_h

#include <voussoir/mesh/coarse_mesh.h>

#include <string>

namespace Voussoir
{
  /**
   * Some lines for the log: size, extent, volume, edges, worst corner, parts
   * that share no vertex, vertices that coincide, and each named set with its
   * volume or area. Lengths in metres.
   */
  std::string
  describe_mesh(const CoarseMesh &mesh);
} // namespace Voussoir

#endif
