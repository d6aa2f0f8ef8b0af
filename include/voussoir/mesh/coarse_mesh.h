#ifndef voussoir_mesh_coarse_mesh_h
#define voussoir_mesh_coarse_mesh_h

#include <deal.II/base/point.h>

#include <array>
#include <map>
#include <string>
#include <vector>

namespace Voussoir
{
  /**
   * A hexahedral mesh with named sets, as generators make it and readers read
   * it, before it becomes a distributed triangulation. Lengths in metres, z up.
   *
   * Sets may overlap: a cell can belong to "dam" and to "block 3".
   */
  struct CoarseMesh
  {
    /** One face of one cell, numbered as deal.II numbers faces: -x +x -y +y -z
     * +z of the reference cell. */
    struct Face
    {
      unsigned int cell;
      unsigned int face;
    };

    std::vector<dealii::Point<3>> vertices;

    /** Vertex indices in deal.II's lexicographic order (x fastest, then y, then
     * z of the reference cell). */
    std::vector<std::array<unsigned int, 8>> cells;

    std::map<std::string, std::vector<unsigned int>> cell_sets;

    /** Sets of outer or inner faces; an inner face is named from one of its two
     * sides. */
    std::map<std::string, std::vector<Face>> face_sets;

    /** Sets of vertices (Abaqus NSET, Gmsh physical points). */
    std::map<std::string, std::vector<unsigned int>> vertex_sets;
  };
} // namespace Voussoir

#endif
