#ifndef voussoir_mesh_mesh_geometry_h
#define voussoir_mesh_mesh_geometry_h

#include <voussoir/mesh/coarse_mesh.h>

#include <array>
#include <string>
#include <vector>

namespace Voussoir
{
  /** The vertices of a face in deal.II's lexicographic order. */
  inline std::array<unsigned int, 4>
  face_vertices(const CoarseMesh &mesh, const CoarseMesh::Face &face)
  {
    // GeometryInfo<3>::face_to_cell_vertices, which is slow
    constexpr std::array<std::array<unsigned int, 4>, 6> corners{
      {{{0, 2, 4, 6}},
       {{1, 3, 5, 7}},
       {{0, 4, 1, 5}},
       {{2, 6, 3, 7}},
       {{0, 1, 2, 3}},
       {{4, 5, 6, 7}}}};
    const auto &cell = mesh.cells[face.cell];
    const auto &of   = corners[face.face];
    return {{cell[of[0]], cell[of[1]], cell[of[2]], cell[of[3]]}};
  }

  /** A face of a cell with its four vertices, in an order that is the same for
   *  both its cells. */
  struct SortedFace
  {
    std::array<unsigned int, 4> vertices; // ascending
    CoarseMesh::Face            face;
  };

  /**
   * All faces of all cells, sorted by their vertices and then by cell, so that
   * the two sides of an inner face stand next to each other.
   */
  std::vector<SortedFace>
  sorted_faces(const CoarseMesh &mesh);

  /**
   * At each vertex of the cell, the triple product of the unit vectors along
   * its three edges: 1 at a right angle, 0 where the corner is flat, negative
   * where it is turned inside out.
   */
  std::array<double, 8>
  corner_shapes(const CoarseMesh &mesh, const unsigned int cell);

  /** Mean of its vertices. */
  dealii::Point<3>
  cell_centre(const CoarseMesh &mesh, const unsigned int cell);

  /** Volume [length^3] of the trilinear cell, exact. */
  double
  cell_volume(const CoarseMesh &mesh, const unsigned int cell);

  /** Area [length^2]; exact for plane faces, by 4x4 Gauss points for others. */
  double
  face_area(const CoarseMesh &mesh, const CoarseMesh::Face &face);

  /** The vertices of a cell, in deal.II's lexicographic order. */
  std::array<dealii::Point<3>, 8>
  cell_vertices(const CoarseMesh &mesh, const unsigned int cell);

  /** "(x, y, z)" for a message. */
  std::string
  describe_point(const dealii::Point<3> &point);
} // namespace Voussoir

#endif
