#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/mesh/interfaces.h>
#include <voussoir/mesh/mesh_check.h>
#include <voussoir/mesh/mesh_geometry.h>
#include <voussoir/mesh/mesh_quality.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/geometry_info.h>
#include <deal.II/base/utilities.h>
#include <deal.II/numerics/rtree.h>

#include <boost/pending/disjoint_sets.hpp>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <limits>
#include <set>
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


    // Peak memory of a run per unknown of elastic cells [bytes].
    constexpr double memory_per_unknown = 1000.;


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
      // deal.II numbers the vertices of opposite faces in the same order, so
      // that they run counterclockwise from outside on +x, +y, +z only.
      const bool outward = face.face % 2 == 1;
      const bool smaller = around[(lowest + 1) % 4] < around[(lowest + 3) % 4];
      return smaller == outward;
    }


    std::array<Point<3>, 8>
    cell_vertices(const CoarseMesh &mesh, const unsigned int cell)
    {
      std::array<Point<3>, 8> vertices;
      for (unsigned int v = 0; v < 8; ++v)
        vertices[v] = mesh.vertices[mesh.cells[cell][v]];
      return vertices;
    }


    std::string
    describe_point(const Point<3> &point)
    {
      std::ostringstream text;
      text << "(" << point[0] << ", " << point[1] << ", " << point[2] << ")";
      return text.str();
    }


    std::string
    place(const CoarseMesh &mesh, const unsigned int cell)
    {
      return "cell " + std::to_string(cell) + " (counted from 0) with centre " +
             describe_point(cell_centre(mesh, cell));
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
          if (!(std::abs(mesh.vertices[v][d]) <= largest_coordinate))
            {
              std::ostringstream text;
              text << where << ": coordinate "
                   << "xyz"[d] << " of vertex " << v << " (counted from 0) is "
                   << mesh.vertices[v][d]
                   << ", which is no place in a mesh; correct it.";
              throw UserError(text.str());
            }
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
    check_coincidence(const CoarseMesh &mesh, const std::string &where)
    {
      for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
        for (unsigned int i = 0; i < 8; ++i)
          for (unsigned int j = 0; j < i; ++j)
            if (const Point<3> &vertex = mesh.vertices[mesh.cells[cell][i]];
                vertex == mesh.vertices[mesh.cells[cell][j]])
              throw UserError(where + ": two vertices of " + place(mesh, cell) +
                              " lie at one place, " + describe_point(vertex) +
                              "; wedges and other collapsed cells must be "
                              "remeshed as hexahedra with eight different "
                              "vertices.");
    }


    void
    check_shapes(const CoarseMesh  &mesh,
                 const std::string &where,
                 const std::string &remedy)
    {
      std::vector<unsigned int> bad;
      for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
        {
          const auto shapes = corner_shapes(mesh, cell);
          // NaN counts as bad
          if (!std::all_of(shapes.begin(),
                           shapes.end(),
                           [](const double shape) {
                             return shape > flat_corner;
                           }))
            bad.push_back(cell);
        }
      if (!bad.empty())
        throw UserError(
          where + ": " + counted(bad.size(), "cell is", "cells are") +
          " flat, inverted or tangled (the Jacobian is not positive at every "
          "vertex), the first is " +
          place(mesh, bad.front()) + "; " + remedy + ".");
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


    // A number for each cell, the same for all cells that are connected by
    // faces.
    std::vector<std::size_t>
    parts_of_cells(const CoarseMesh &mesh)
    {
      boost::disjoint_sets_with_storage<> parts(mesh.cells.size());
      const std::vector<SortedFace>       faces = sorted_faces(mesh);
      for (unsigned int i = 1; i < faces.size(); ++i)
        if (same_vertices(faces[i - 1], faces[i]))
          parts.union_set(faces[i].face.cell, faces[i - 1].face.cell);
      std::vector<std::size_t> result;
      for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
        result.push_back(parts.find_set(cell));
      return result;
    }


    // Points well inside of a cell, near its vertices and in the middle.
    std::array<Point<3>, 9>
    inner_points(const CoarseMesh &mesh, const unsigned int cell)
    {
      std::array<Point<3>, 9> points;
      for (unsigned int i = 0; i < 9; ++i)
        {
          const Point<3> unit =
            i == 8 ? Point<3>(0.5, 0.5, 0.5) :
                     Point<3>(0.9 * GeometryInfo<3>::unit_cell_vertex(i) +
                              Point<3>(0.05, 0.05, 0.05));
          for (unsigned int v = 0; v < 8; ++v)
            points[i] += GeometryInfo<3>::d_linear_shape_function(unit, v) *
                         mesh.vertices[mesh.cells[cell][v]];
        }
      return points;
    }


    // Whether a point lies inside of a cell, below all triangles that its faces
    // can be cut into.
    bool
    is_inside(const CoarseMesh  &mesh,
              const unsigned int cell,
              const Point<3>    &point)
    {
      for (unsigned int face = 0; face < 6; ++face)
        {
          const auto v = face_vertices(mesh, {cell, face});
          // counterclockwise from outside
          std::array<unsigned int, 4> around = {{v[0], v[1], v[3], v[2]}};
          if (face % 2 == 0)
            std::reverse(around.begin(), around.end());
          for (unsigned int i = 0; i < 4; ++i)
            {
              const Point<3> &a = mesh.vertices[around[i]];
              if (cross_product_3d(mesh.vertices[around[(i + 1) % 4]] - a,
                                   mesh.vertices[around[(i + 2) % 4]] - a) *
                    (point - a) >=
                  0.)
                return false;
            }
        }
      return true;
    }


    // Parts that share no face can lie in the same place, wholly or partly.
    void
    check_overlap(const CoarseMesh &mesh, const std::string &where)
    {
      const std::vector<std::size_t> part = parts_of_cells(mesh);
      if (std::all_of(part.begin(), part.end(), [&](const std::size_t number) {
            return number == part[0];
          }))
        return;
      std::vector<std::pair<BoundingBox<3>, unsigned int>> boxes;
      for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
        {
          std::vector<Point<3>> corners;
          for (const unsigned int v : mesh.cells[cell])
            corners.push_back(mesh.vertices[v]);
          boxes.emplace_back(BoundingBox<3>(corners), cell);
        }
      const auto tree = pack_rtree(boxes);
      for (const auto &[box, cell] : boxes)
        {
          const unsigned int this_cell = cell;
          const auto         points    = inner_points(mesh, cell);
          const auto         overlaps =
            [&](const std::pair<BoundingBox<3>, unsigned int> &other) {
              return part[other.second] != part[this_cell] &&
                     std::any_of(points.begin(),
                                 points.end(),
                                 [&](const Point<3> &point) {
                                   return is_inside(mesh, other.second, point);
                                 });
            };
          namespace bgi = boost::geometry::index;
          const auto other =
            tree.qbegin(bgi::intersects(box) && bgi::satisfies(overlaps));
          if (other != tree.qend())
            throw UserError(where + ": " + place(mesh, cell) + " and cell " +
                            std::to_string(other->second) +
                            " lie in the same place but share no face; remove "
                            "one of them, or mesh both together.");
        }
    }


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
    // are much wider than the tolerance, so most vertices search one only.
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


  void
  check_mesh(const CoarseMesh  &mesh,
             const std::string &where,
             const std::string &remedy)
  {
    if (mesh.cells.empty())
      throw UserError(where +
                      ": there is no hexahedron in the mesh; export the "
                      "volume elements.");
    check_vertices(mesh, where);
    check_repetition(mesh, where);
    check_coincidence(mesh, where);
    check_shapes(mesh, where, remedy);
    check_neighbours(mesh, where);
    check_overlap(mesh, where);
  }


  void
  check_size(const double       n_cells,
             const unsigned int degree,
             const std::string &place,
             const MPI_Comm     communicator)
  {
    MPI_Comm machine;
    MPI_Comm_split_type(
      communicator, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    const bool first = Utilities::MPI::this_mpi_process(machine) == 0;
    MPI_Comm_free(&machine);
    const double n_machines =
      Utilities::MPI::sum(first ? 1. : 0., communicator);
    const double n_unknowns = 3. * n_cells * Utilities::pow(degree, 3),
                 needed     = memory_per_unknown * n_unknowns,
                 memory     = static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                          sysconf(_SC_PAGESIZE) * n_machines;
    if (needed <= memory)
      return;
    std::ostringstream text;
    text << std::setprecision(2) << place << ": about " << n_cells
         << " cells with " << n_unknowns << " unknowns would result, "
         << needed / 1e9 << " GB, but there are only " << memory / 1e9
         << " GB of memory; use larger or fewer cells.";
    throw UserError(text.str());
  }


  std::vector<MeshPart>
  find_parts(const CoarseMesh               &mesh,
             const std::vector<std::string> &fixed_sets,
             const std::vector<std::string> &interfaces)
  {
    boost::disjoint_sets_with_storage<> parts(mesh.vertices.size());
    for (const auto &cell : mesh.cells)
      for (const unsigned int vertex : cell)
        parts.union_set(cell[0], vertex);
    for (const std::string &interface : interfaces)
      {
        const auto &first = mesh.face_sets.at(interface),
                   &other = mesh.face_sets.at(interface + other_side);
        for (unsigned int i = 0; i < first.size(); ++i)
          parts.union_set(mesh.cells[first[i].cell][0],
                          mesh.cells[other[i].cell][0]);
      }
    std::set<std::size_t> fixed;
    for (const std::string &set : fixed_sets)
      if (const auto faces = mesh.face_sets.find(set);
          faces != mesh.face_sets.end())
        for (const CoarseMesh::Face &face : faces->second)
          fixed.insert(parts.find_set(mesh.cells[face.cell][0]));

    std::set<std::size_t> seen;
    std::vector<MeshPart> result;
    for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
      if (const std::size_t part = parts.find_set(mesh.cells[cell][0]);
          seen.insert(part).second)
        result.push_back(
          {describe_point(cell_centre(mesh, cell)), fixed.count(part) > 0});
    return result;
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
