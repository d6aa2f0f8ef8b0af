#ifndef voussoir_mesh_coarse_mesh_h
#define voussoir_mesh_coarse_mesh_h

#include <deal.II/base/numbers.h>
#include <deal.II/base/point.h>

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace Voussoir
{
  /** Index of a vertex, edge or cell that does not exist. */
  constexpr unsigned int none = dealii::numbers::invalid_unsigned_int;

  /**
   * A hexahedral mesh with named sets, as generators make it and readers read
   * it, before it becomes a distributed triangulation. Lengths in metres, z up.
   *
   * Sets may overlap: a cell can belong to "dam" and to "block 3".
   */
  struct CoarseMesh
  {
    /** One face of one cell, numbered as deal.II numbers faces: -x +x -y +y -z
     *  +z of the reference cell. */
    struct Face
    {
      unsigned int cell;
      unsigned int face;
    };

    /**
     * The true geometry: coordinates in which cells are refined, so that new
     * vertices lie on the surfaces that the coarse faces approximate. Like
     * deal.II's ChartManifold, but each vertex keeps its coordinates, so that
     * no pull-back is needed.
     */
    struct Chart
    {
      using Points = std::vector<dealii::Point<3>>;

      /** Coordinates of each vertex; none if cells are refined in space, at the
       *  midpoints of edges. */
      Points vertices;

      /** Maps such coordinates to space [m]. */
      std::function<Points(const Points &)> positions;

      /** Moves the coordinates of a new vertex. */
      using Move = std::function<dealii::Point<3>(const dealii::Point<3> &)>;

      /** A surface that is curved in these coordinates. */
      struct Surface
      {
        std::vector<Face> faces; // from all their sides
        Move              onto;
      };

      std::vector<Surface> surfaces;

      /** Onto the edge where two of the surfaces meet. */
      Move onto_edge;
    };

    std::vector<dealii::Point<3>> vertices;

    Chart chart;

    /** Vertex indices in deal.II's lexicographic order (x fastest, then y, then
     *  z of the reference cell). */
    std::vector<std::array<unsigned int, 8>> cells;

    std::map<std::string, std::vector<unsigned int>> cell_sets;

    /** Sets of outer or inner faces; an inner face is named from one of its two
     *  sides. */
    std::map<std::string, std::vector<Face>> face_sets;

    /** Sets of vertices (Abaqus NSET, Gmsh physical points). */
    std::map<std::string, std::vector<unsigned int>> vertex_sets;

    /** Lines for the log on deviations of the mesh from its entries. */
    std::vector<std::string> remarks;
  };
} // namespace Voussoir

#endif
