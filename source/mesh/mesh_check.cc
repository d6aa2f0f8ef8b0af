#include <voussoir/base/error.h>
#include <voussoir/base/machine.h>
#include <voussoir/base/text.h>
#include <voussoir/mesh/mesh_check.h>
#include <voussoir/mesh/mesh_geometry.h>
#include <voussoir/mesh/mesh_parts.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/geometry_info.h>
#include <deal.II/base/utilities.h>
#include <deal.II/numerics/rtree.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Corners flatter than this are flat but for round-off.
    constexpr double flat_corner = 1e-6;

    // Peak memory of a run per unknown of elastic cells [bytes]; measured with
    // degree 1: 510 to 550, and less with higher degrees.
    constexpr double memory_per_unknown = 500.;

    // Memory of a rank per cell before refinement, with p4est [bytes].
    constexpr double memory_per_coarse_cell = 1500.;


    // Whether the face, run through counterclockwise as seen from outside its
    // cell, goes from its lowest vertex to the smaller of the two neighbours.
    // The face has opposite orientations in the two cells that share it.
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


  double
  memory_of_machine()
  {
    return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE);
  }


  void
  check_size(const double       n_cells,
             const unsigned int degree,
             const std::string &place,
             const double       machines)
  {
    const double n_unknowns = 3. * n_cells * Utilities::pow(degree, 3),
                 needed     = memory_per_unknown * n_unknowns,
                 memory     = memory_of_machine() * machines;
    if (needed <= memory)
      return;
    std::ostringstream text;
    text << std::setprecision(2) << place << ": about " << n_cells
         << " cells with " << n_unknowns << " unknowns would result, "
         << needed / 1e9 << " GB, but there are only " << memory / 1e9
         << " GB of memory; use larger or fewer cells.";
    throw UserError(text.str());
  }


  void
  check_copies(const double n_cells, const MPI_Comm communicator)
  {
    const double ranks  = Utilities::MPI::n_mpi_processes(communicator),
                 needed = memory_per_coarse_cell * n_cells * ranks,
                 memory = memory_of_machine() *
                          RanksOfMachine(communicator).n_machines();
    if (needed <= memory)
      return;
    std::ostringstream text;
    text << std::setprecision(2)
         << "\"Partition = p4est\" in section \"Mesh\" stores the " << n_cells
         << " cells before refinement on each of the " << ranks << " ranks, "
         << needed / 1e9 << " GB in all, but there are only " << memory / 1e9
         << " GB of memory; give larger cells with a \"Global refinement\", "
            "\"Partition = METIS\", or take fewer ranks.";
    throw UserError(text.str());
  }
} // namespace Voussoir
