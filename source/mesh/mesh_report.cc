#include <voussoir/base/text.h>
#include <voussoir/mesh/mesh_geometry.h>
#include <voussoir/mesh/mesh_parts.h>
#include <voussoir/mesh/mesh_quality.h>
#include <voussoir/mesh/mesh_report.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/geometry_info.h>

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
    // Vertices nearer than this part of the shortest edge are taken to
    // coincide.
    constexpr double coincidence = 1e-6;


    // The number of cells in each part, largest first.
    std::vector<std::size_t>
    sizes_of_parts(const CoarseMesh &mesh)
    {
      std::vector<std::size_t> size(mesh.cells.size(), 0);
      for (const std::size_t part : parts_of_cells(mesh))
        ++size[part];
      std::sort(size.rbegin(), size.rend());
      size.erase(std::find(size.begin(), size.end(), 0U), size.end());
      return size;
    }


    // Lengths of the shortest and the longest edge [m].
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


    // Number of vertices that coincide with a vertex of lower number. The bins
    // are much wider than the tolerance, so that most vertices search only one
    // bin.
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
      const std::vector<std::size_t> parts = sizes_of_parts(mesh);
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
          double      volume = 0;
          MeshQuality quality;
          for (const unsigned int cell : cells)
            {
              volume += cell_volume(mesh, cell);
              quality.take(cell_vertices(mesh, cell));
              is_named[cell] = true;
            }
          text << "  cells \"" << name
               << "\": " << counted(cells.size(), "cell", "cells")
               << ", volume " << volume << " m3, " << quality.describe()
               << "\n";
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
