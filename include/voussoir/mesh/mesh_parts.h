#ifndef voussoir_mesh_mesh_parts_h
#define voussoir_mesh_mesh_parts_h

#include <voussoir/mesh/coarse_mesh.h>

#include <string>
#include <vector>

namespace Voussoir
{
  /** A number for each cell, the same for all cells that are connected by
   *  faces. */
  std::vector<std::size_t>
  parts_of_cells(const CoarseMesh &mesh);

  /** A part of the mesh that is connected by vertices and interfaces. */
  struct MeshPart
  {
    std::string place; // "(x, y, z)" of a cell in it
    bool        is_fixed;
  };

  /**
   * The parts of a mesh that is split along the @p interfaces; those that have
   * faces in the @p fixed_sets are fixed.
   */
  std::vector<MeshPart>
  find_parts(const CoarseMesh               &mesh,
             const std::vector<std::string> &fixed_sets,
             const std::vector<std::string> &interfaces);
} // namespace Voussoir

#endif
