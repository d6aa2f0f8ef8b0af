#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/mesh/mesh_check.h>
#include <voussoir/mesh/mesh_geometry.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/geometry_info.h>

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <unordered_map>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Corners flatter than this are round-off of a flat corner.
    constexpr double flat_corner = 1e-6;

    // Vertices nearer than this part of the shortest edge are taken to
    // coincide.
    constexpr double coincidence = 1e-6;


    // Whether the face, run through counterclockwise as seen from outside its
    // cell, goes from its lowest vertex to the smaller of the two neighbours.
    // The cells on the two sides of a face see opposite senses.
    bool
    turns_to_smaller_neighbour(const CoarseMesh       &mesh,
                               const CoarseMesh::Face &face)
    {
      const std::array<unsigned int, 4> v      = face_vertices(mesh, face);
      const std::array<unsigned int, 4> around = {{v[0], v[1], v[3], v[2]}};
      const unsigned int                lowest =
        std::min_element(around.begin(), around.end()) - around.begin();
      // deal.II numbers the vertices of opposite faces alike, so that they run
      // counterclockwise from outside on +x, +y, +z only.
      const bool outward = face.face % 2 == 1;
      const bool smaller = around[(lowest + 1) % 4] < around[(lowest + 3) % 4];
      return smaller == outward;
    }


    Point<3>
    cell_center(const CoarseMesh &mesh, const unsigned int cell)
    {
      Point<3> center;
      for (const unsigned int v : mesh.cells[cell])
        center += mesh.vertices[v] / 8.;
      return center;
    }


    std::string
    place(const CoarseMesh &mesh, const unsigned int cell)
    {
      const Point<3>     center = cell_center(mesh, cell);
      std::ostringstream text;
      text << "cell " << cell << " (counted from 0) with centre (" << center[0]
           << ", " << center[1] << ", " << center[2] << ")";
      return text.str();
    }


    bool
    same_vertices(const SortedFace &a, const SortedFace &b)
    {
      return a.vertices == b.vertices;
    }


    void
    check_vertices(const CoarseMesh &mesh, const std::string &where)
    {
      for (unsigned int v = 0; v < mesh.vertices.size(); ++v)
        for (unsigned int d = 0; d < 3; ++d)
          if (!std::isfinite(mesh.vertices[v][d]))
            throw UserError(where + ": coordinate " + "xyz"[d] + " of vertex " +
                            std::to_string(v) +
                            " (counted from 0) is not a finite number; correct "
                            "the coordinates in the mesh.");
    }


    void
    check_repetition(const CoarseMesh &mesh, const std::string &where)
    {
      using SortedCell = std::pair<std::array<unsigned int, 8>, unsigned int>;
      std::vector<SortedCell> sorted(mesh.cells.size());
      for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
        {
          sorted[cell]   = {mesh.cells[cell], cell};
          auto &vertices = sorted[cell].first;
          std::sort(vertices.begin(), vertices.end());
          if (std::adjacent_find(vertices.begin(), vertices.end()) !=
              vertices.end())
            throw UserError(where + ": " + place(mesh, cell) +
                            " names one vertex twice; wedges and other "
                            "collapsed cells must be remeshed as hexahedra "
                            "with eight different vertices.");
        }

      std::sort(sorted.begin(), sorted.end());
      const auto twin =
        std::adjacent_find(sorted.begin(),
                           sorted.end(),
                           [](const SortedCell &a, const SortedCell &b) {
                             return a.first == b.first;
                           });
      if (twin != sorted.end())
        throw UserError(where + ": " + place(mesh, twin->second) +
                        " has the same eight vertices as cell " +
                        std::to_string(std::next(twin)->second) +
                        "; remove the duplicate cells.");
    }


    void
    check_shapes(const CoarseMesh &mesh, const std::string &where)
    {
      std::vector<unsigned int> bad;
      for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
        {
          const auto shapes = corner_shapes(mesh, cell);
          // Written so that the NaN of an edge of no length counts as bad.
          if (!(*std::min_element(shapes.begin(), shapes.end()) > flat_corner))
            bad.push_back(cell);
        }
      if (!bad.empty())
        throw UserError(
          where + ": " + counted(bad.size(), "cell is", "cells are") +
          " flat, inverted or tangled (the Jacobian is not positive at every "
          "vertex), the first is " +
          place(mesh, bad.front()) + "; improve the mesh there.");
    }


    void
    check_neighbours(const CoarseMesh &mesh, const std::string &where)
    {
      const std::vector<SortedFace> faces = sorted_faces(mesh);
      for (auto side = faces.begin(); side != faces.end();)
        {
          const auto end =
            std::find_if_not(side, faces.end(), [&](const SortedFace &other) {
              return same_vertices(*side, other);
            });
          if (end - side > 2)
            throw UserError(where + ": " + std::to_string(end - side) +
                            " cells share one face, among them " +
                            place(mesh, side->face.cell) + " and cell " +
                            std::to_string(std::next(side)->face.cell) +
                            "; a face can have two cells at most, so remove "
                            "the cells that overlap.");
          if (end - side == 2 &&
              turns_to_smaller_neighbour(mesh, side->face) ==
                turns_to_smaller_neighbour(mesh, std::next(side)->face))
            throw UserError(where + ": " + place(mesh, side->face.cell) +
                            " and cell " +
                            std::to_string(std::next(side)->face.cell) +
                            " lie on the same side of the face they share; "
                            "correct the mesh where they overlap.");
          side = end;
        }
    }


    // Parts of the mesh that share no face: the number of cells in each,
    // largest first.
    std::vector<std::size_t>
    connected_parts(const CoarseMesh &mesh)
    {
      boost::disjoint_sets_with_storage<> parts(mesh.cells.size());
      const std::vector<SortedFace>       faces = sorted_faces(mesh);
      for (unsigned int i = 1; i < faces.size(); ++i)
        if (same_vertices(faces[i - 1], faces[i]))
          parts.union_set(faces[i].face.cell, faces[i - 1].face.cell);

      std::vector<std::size_t> size(mesh.cells.size(), 0);
      for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
        ++size[parts.find_set(cell)];
      std::sort(size.rbegin(), size.rend());
      size.erase(std::find(size.begin(), size.end(), 0U), size.end());
      return size;
    }


    // The shortest and the longest one [m].
    std::pair<double, double>
    edge_lengths(const CoarseMesh &mesh)
    {
      double shortest = std::numeric_limits<double>::max(), longest = 0;
      for (const auto &cell : mesh.cells)
        for (unsigned int line = 0; line < GeometryInfo<3>::lines_per_cell;
             ++line)
          {
            const auto &a =
              mesh.vertices[cell[GeometryInfo<3>::line_to_cell_vertices(line,
                                                                        0)]];
            const auto &b =
              mesh.vertices[cell[GeometryInfo<3>::line_to_cell_vertices(line,
                                                                        1)]];
            shortest = std::min(shortest, a.distance(b));
            longest  = std::max(longest, a.distance(b));
          }
      return {shortest, longest};
    }


    // How many vertices lie where a vertex of lower number is already. The bins
    // are much wider than the tolerance, so most vertices look into one only.
    unsigned int
    n_coincident_vertices(const CoarseMesh &mesh, const double shortest_edge)
    {
      const double tolerance = coincidence * shortest_edge;
      const auto   bin       = [&](const Point<3> &p) {
        std::size_t key = 0;
        for (unsigned int d = 0; d < 3; ++d)
          key = key * 0x9E3779B97F4A7C15u +
                static_cast<std::size_t>(
                  static_cast<std::int64_t>(std::floor(p[d] / shortest_edge)));
        return key;
      };

      std::unordered_multimap<std::size_t, unsigned int> bins;
      bins.reserve(mesh.vertices.size());
      unsigned int n = 0;
      for (unsigned int v = 0; v < mesh.vertices.size(); ++v)
        {
          const Point<3>          &p = mesh.vertices[v];
          std::vector<std::size_t> keys;
          for (unsigned int corner = 0; corner < 8; ++corner)
            keys.push_back(bin(
              p + tolerance * (2. * GeometryInfo<3>::unit_cell_vertex(corner) -
                               Point<3>(1, 1, 1))));
          std::sort(keys.begin(), keys.end());
          keys.erase(std::unique(keys.begin(), keys.end()), keys.end());

          n +=
            std::any_of(keys.begin(), keys.end(), [&](const std::size_t key) {
              const auto range = bins.equal_range(key);
              return std::any_of(
                range.first, range.second, [&](const auto &entry) {
                  return p.distance(mesh.vertices[entry.second]) < tolerance;
                });
            });
          bins.emplace(bin(p), v);
        }
      return n;
    }


    void
    describe_shape(const CoarseMesh   &mesh,
                   const double        shortest_edge,
                   const double        longest_edge,
                   std::ostringstream &text)
    {
      double volume = 0, worst_corner = 1;
      for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
        {
          volume += cell_volume(mesh, cell);
          const auto shapes = corner_shapes(mesh, cell);
          worst_corner =
            std::min(worst_corner,
                     *std::min_element(shapes.begin(), shapes.end()));
        }

      const BoundingBox<3> box(mesh.vertices);
      text << "Mesh: " << counted(mesh.cells.size(), "cell", "cells") << ", "
           << counted(mesh.vertices.size(), "vertex", "vertices") << ", volume "
           << volume << " m3\n  extent";
      for (unsigned int d = 0; d < 3; ++d)
        text << (d == 0 ? " " : ", ") << "xyz"[d] << " " << box.lower_bound(d)
             << " to " << box.upper_bound(d) << " m";
      text << "\n  edges " << shortest_edge << " to " << longest_edge
           << " m, worst corner " << worst_corner
           << " (1: right angle, 0: flat)\n";
    }


    void
    describe_connection(const CoarseMesh   &mesh,
                        const double        shortest_edge,
                        std::ostringstream &text)
    {
      const std::vector<std::size_t> parts = connected_parts(mesh);
      if (parts.size() > 1)
        {
          text << "  " << parts.size()
               << " parts that share no face, of these numbers of cells:";
          for (unsigned int i = 0; i < std::min<std::size_t>(parts.size(), 10);
               ++i)
            text << " " << parts[i];
          text << (parts.size() > 10 ? " ...\n" : "\n");
        }
      const unsigned int n_coincident =
        n_coincident_vertices(mesh, shortest_edge);
      if (n_coincident > 0)
        text << "  "
             << counted(n_coincident,
                        "vertex lies on another vertex",
                        "vertices lie on another vertex")
             << ": the cells there are not connected (right for a joint or "
                "slit)\n";
    }


    void
    describe_sets(const CoarseMesh &mesh, std::ostringstream &text)
    {
      std::vector<bool> is_named(mesh.cells.size(), false);
      for (const auto &[name, cells] : mesh.cell_sets)
        {
          double volume = 0;
          for (const unsigned int cell : cells)
            {
              volume += cell_volume(mesh, cell);
              is_named[cell] = true;
            }
          text << "  cells \"" << name
               << "\": " << counted(cells.size(), "cell", "cells")
               << ", volume " << volume << " m3\n";
        }
      const std::size_t n_unnamed =
        std::count(is_named.begin(), is_named.end(), false);
      if (n_unnamed > 0)
        text << "  " << counted(n_unnamed, "cell belongs", "cells belong")
             << " to no named set\n";

      for (const auto &[name, faces] : mesh.face_sets)
        {
          double area = 0;
          for (const CoarseMesh::Face &face : faces)
            area += face_area(mesh, face);
          text << "  faces \"" << name
               << "\": " << counted(faces.size(), "face", "faces") << ", area "
               << area << " m2\n";
        }
      for (const auto &[name, vertices] : mesh.vertex_sets)
        text << "  vertices \"" << name
             << "\": " << counted(vertices.size(), "vertex", "vertices")
             << "\n";
    }
  } // namespace


  void
  check_mesh(const CoarseMesh &mesh, const std::string &where)
  {
    if (mesh.cells.empty())
      throw UserError(where +
                      ": there is no hexahedron in the mesh; export the "
                      "volume elements.");
    check_vertices(mesh, where);
    check_repetition(mesh, where);
    check_shapes(mesh, where);
    check_neighbours(mesh, where);
  }


  std::string
  describe_mesh(const CoarseMesh &mesh)
  {
    const auto [shortest_edge, longest_edge] = edge_lengths(mesh);
    std::ostringstream text;
    describe_shape(mesh, shortest_edge, longest_edge, text);
    describe_connection(mesh, shortest_edge, text);
    describe_sets(mesh, text);
    return text.str();
  }
} // namespace Voussoir
