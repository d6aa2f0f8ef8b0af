#ifndef voussoir_mesh_mesh_check_h
#define voussoir_mesh_mesh_check_h

#include <voussoir/mesh/coarse_mesh.h>

#include <string>

namespace Voussoir
{
  /**
   * Throw UserError, with a sentence that begins with @p where, if the mesh is
   * empty, has coordinates that are no finite numbers, cells that name a vertex
   * twice, duplicate cells, inverted or tangled cells, cells that overlap
   * across a face, or faces with more than two cells.
   */
  void
  check_mesh(const CoarseMesh &mesh, const std::string &where);

  /**
   * Some lines for the log: size, extent, volume, edges, worst corner, parts
   * that share no vertex, vertices that coincide, and each named set with its
   * volume or area. Lengths in metres.
   */
  std::string
  describe_mesh(const CoarseMesh &mesh);
} // namespace Voussoir

#endif
