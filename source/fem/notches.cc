#include <voussoir/fem/notches.h>
#include <voussoir/mesh/interfaces.h>

#include <deal.II/base/geometry_info.h>

#include <boost/math/tools/roots.hpp>

#include <set>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr double curved_face = 20. * numbers::PI / 180.;

    using Line = TriaIterator<TriaAccessor<1, 3, 3>>;


    /** Angle between two faces of a cell at their common edge, at the middle of
     *  it [rad]. */
    template <typename Face>
    double
    angle_between(const Face &face_1, const Face &face_2, const Line &edge)
    {
      const Tensor<1, 3> along =
        (edge->vertex(1) - edge->vertex(0)) / edge->diameter();
      const auto into = [&](const Face &face) {
        Point<3> middle;
        for (const unsigned int v : face->vertex_indices())
          middle += face->vertex(v) / 4.;
        const Tensor<1, 3> from_edge =
          middle - 0.5 * (edge->vertex(0) + edge->vertex(1));
        return Tensor<1, 3>(from_edge - (from_edge * along) * along);
      };
      const Tensor<1, 3> a = into(face_1), b = into(face_2);
      return std::acos(std::clamp(a * b / (a.norm() * b.norm()), -1., 1.));
    }


    using Faces = std::set<std::pair<unsigned int, unsigned int>>;


    /** Active cell indices and numbers of the faces of interfaces. */
    Faces
    faces_of_interfaces(const Grid &grid)
    {
      Faces       faces;
      const auto &names = grid.face_set_names();
      for (const std::string &name : names)
        if (const std::string other = name + other_side;
            std::find(names.begin(), names.end(), other) != names.end())
          for (const std::string &side : {name, other})
            for (const Grid::Face &face : grid.faces(side))
              faces.emplace(face.cell->active_cell_index(), face.face);
      return faces;
    }


    /** What meets at the edges of the mesh, by their indices. */
    struct Edges
    {
      std::vector<double> angles;  // of all cells around the edge [rad]
      std::vector<bool>   is_free; // whether a face without traction ends there
    };


    /** Adds a cell to an edge, or to its two halves where its neighbours are
     *  refined. */
    void
    add(Edges &edges, const Line &edge, const double angle, const bool is_free)
    {
      edges.angles[edge->index()] += angle;
      if (is_free)
        edges.is_free[edge->index()] = true;
      if (edge->has_children())
        for (unsigned int c = 0; c < edge->n_children(); ++c)
          add(edges, edge->child(c), angle, is_free);
    }


    /** Angle of all cells around an edge, or around the halves of one whose
     *  other cells are refined; zero if no free face ends there [rad]. */
    double
    angle_around(const Edges &edges, const Line &edge)
    {
      if (!edge->has_children())
        return edges.is_free[edge->index()] ? edges.angles[edge->index()] : 0.;
      double largest = 0.;
      for (unsigned int c = 0; c < edge->n_children(); ++c)
        largest = std::max(largest, angle_around(edges, edge->child(c)));
      return largest;
    }


    /** The two faces of a hexahedron at each of its edges. */
    std::array<std::array<unsigned int, 2>, 12>
    faces_at_edges()
    {
      using Cell = GeometryInfo<3>;
      std::array<std::vector<unsigned int>, 12> found;
      for (const unsigned int f : Cell::face_indices())
        for (unsigned int k = 0; k < Cell::lines_per_face; ++k)
          found[Cell::face_to_cell_lines(f, k)].push_back(f);
      std::array<std::array<unsigned int, 2>, 12> faces;
      for (unsigned int l = 0; l < 12; ++l)
        faces[l] = {{found[l][0], found[l][1]}};
      return faces;
    }


    Edges
    find_edges(const Grid &grid)
    {
      const auto         of_edges      = faces_at_edges();
      const Faces        on_interfaces = faces_of_interfaces(grid);
      const unsigned int n             = grid.triangulation().n_raw_lines();
      Edges              edges{std::vector<double>(n), std::vector<bool>(n)};
      for (const auto &cell : grid.triangulation().active_cell_iterators())
        if (!cell->is_artificial())
          for (const unsigned int l : cell->line_indices())
            {
              const std::array<unsigned int, 2> &faces = of_edges[l];
              add(edges,
                  cell->line(l),
                  angle_between(cell->face(faces[0]),
                                cell->face(faces[1]),
                                cell->line(l)),
                  std::any_of(faces.begin(),
                              faces.end(),
                              [&](const unsigned int f) {
                                return cell->at_boundary(f) &&
                                       on_interfaces.count(
                                         {cell->active_cell_index(), f}) == 0;
                              }));
            }
      return edges;
    }
  } // namespace


  double
  order_of_singularity(const double angle)
  {
    if (angle <= numbers::PI)
      return 0.;
    if (angle >= 2. * numbers::PI)
      return 0.5;
    const auto bracket = boost::math::tools::bisect(
      [&](const double k) { return std::sin(k * angle) + k * std::sin(angle); },
      0.5,
      1.,
      boost::math::tools::eps_tolerance<double>());
    return 1. - bracket.first;
  }


  std::vector<double>
  angles_at_notches(const Grid &grid)
  {
    const Edges         edges = find_edges(grid);
    std::vector<double> angles;
    for (const auto &cell : grid.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          double largest = 0.;
          for (const unsigned int l : cell->line_indices())
            largest = std::max(largest, angle_around(edges, cell->line(l)));
          // equal on all ranks, which add in different orders
          largest = std::round(largest * 1e9) * 1e-9;
          angles.push_back(largest < numbers::PI + curved_face ? 0. : largest);
        }
    return angles;
  }


  double
  strength_at_notch(const CellKernel &kernel,
                    const double      angle,
                    const double      cell_size)
  {
    if (angle == 0.)
      return 1.;
    const double counted =
      2. * Utilities::fixed_power<4>(angle / (2. * numbers::PI));
    return std::pow(kernel.tip_strength(counted * cell_size),
                    2. * order_of_singularity(angle));
  }


  void
  weaken_at_notches(const Discretization                  &discretization,
                    const std::vector<const CellKernel *> &kernels,
                    MaterialMemory                        &memory)
  {
    if (memory.empty() ||
        std::none_of(kernels.begin(), kernels.end(), [](const auto *kernel) {
          return kernel->cracks_grow();
        }))
      return;
    const std::vector<double> angles = angles_at_notches(discretization.grid);
    for (unsigned int m = 0; m < kernels.size(); ++m)
      if (kernels[m]->cracks_grow())
        for (const auto &[cell, place] : memory.of(m)->cells())
          if (const double angle = angles[discretization.grid.owned_cell(cell)];
              angle > 0.)
            memory.of(m)->tips_of(place.batch).strength[place.lane] =
              strength_at_notch(*kernels[m], angle, std::cbrt(cell->measure()));
  }
} // namespace Voussoir
