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


    /** What meets at an edge of the mesh. */
    struct Edge
    {
      double       angle   = 0.; // of all cells around it [rad]
      unsigned int n_cells = 0;
      bool         is_free = false; // a face without traction ends there
    };

    using Edges = std::vector<Edge>; // by the indices of lines


    /** Adds a cell to an edge, or to its two halves where its neighbours are
     *  refined. */
    void
    add(Edges &edges, const Line &line, const double angle, const bool is_free)
    {
      Edge &found = edges[line->index()];
      found.angle += angle;
      ++found.n_cells;
      found.is_free = found.is_free || is_free;
      if (line->has_children())
        for (unsigned int c = 0; c < line->n_children(); ++c)
          add(edges, line->child(c), angle, is_free);
    }


    Notch
    sharper(const Notch &a, const Notch &b)
    {
      return a.angle < b.angle ? b : a;
    }


    /** The notch at an edge, or the sharpest one at the halves of an edge whose
     *  other cells are refined. */
    Notch
    notch_at(const Edges &edges, const Line &line)
    {
      Notch sharpest;
      if (line->has_children())
        {
          for (unsigned int c = 0; c < line->n_children(); ++c)
            sharpest = sharper(sharpest, notch_at(edges, line->child(c)));
          return sharpest;
        }
      const Edge &edge = edges[line->index()];
      // equal on all ranks, which add in different orders
      const double angle = 1e-9 * std::round(1e9 * edge.angle);
      if (edge.is_free && angle >= numbers::PI + curved_face)
        sharpest = {angle, edge.n_cells % 2 == 0};
      return sharpest;
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
      const auto  of_edges      = faces_at_edges();
      const Faces on_interfaces = faces_of_interfaces(grid);
      Edges       edges(grid.triangulation().n_raw_lines());
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


  std::vector<Notch>
  notches_of_cells(const Grid &grid)
  {
    const Edges        edges = find_edges(grid);
    std::vector<Notch> notches;
    for (const auto &cell : grid.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          Notch notch;
          for (const unsigned int l : cell->line_indices())
            notch = sharper(notch, notch_at(edges, cell->line(l)));
          notches.push_back(notch);
        }
    return notches;
  }


  double
  strength_at_notch(const CellKernel &kernel,
                    const Notch      &notch,
                    const double      cell_size)
  {
    if (notch.angle == 0.)
      return 1.;
    const double counted =
      notch.is_between_cells ?
        2. :
        2. * Utilities::fixed_power<4>(notch.angle / (2. * numbers::PI));
    return std::pow(kernel.tip_strength(counted * cell_size),
                    2. * order_of_singularity(notch.angle));
  }


  bool
  any_cracks_grow(const std::vector<const CellKernel *> &kernels)
  {
    return std::any_of(kernels.begin(), kernels.end(), [](const auto *kernel) {
      return kernel->cracks_grow();
    });
  }


  void
  weaken_at_notches(const Discretization                  &discretization,
                    const std::vector<const CellKernel *> &kernels,
                    MaterialMemory                        &memory)
  {
    if (memory.empty() || !any_cracks_grow(kernels))
      return;
    const std::vector<Notch> notches = notches_of_cells(discretization.grid);
    for (unsigned int m = 0; m < kernels.size(); ++m)
      if (kernels[m]->cracks_grow())
        for (const auto &[cell, place] : memory.of(m)->cells())
          if (const Notch &notch =
                notches[discretization.grid.owned_cell(cell)];
              notch.angle > 0.)
            memory.of(m)->tips_of(place.batch).strength[place.lane] =
              strength_at_notch(*kernels[m], notch, std::cbrt(cell->measure()));
  }
} // namespace Voussoir
