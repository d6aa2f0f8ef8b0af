#include <voussoir/grid/chart_vertices.h>

#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // New vertices on a curved surface or edge, in the coordinates of a chart.
    class CurvedSurface : public FlatManifold<3>
    {
    public:
      explicit CurvedSurface(const CoarseMesh::Chart::Move &onto)
        : onto(onto)
      {}

      std::unique_ptr<Manifold<3>>
      clone() const override
      {
        return std::make_unique<CurvedSurface>(*this);
      }

      Point<3>
      get_new_point(const ArrayView<const Point<3>> &points,
                    const ArrayView<const double>   &weights) const override
      {
        return onto(FlatManifold<3>::get_new_point(points, weights));
      }

    private:
      CoarseMesh::Chart::Move onto;
    };


    // A surface and the edges of two of them.
    types::manifold_id
    manifold_of_surface(const unsigned int number)
    {
      return number + 1;
    }


    types::manifold_id
    manifold_of_edges(const CoarseMesh::Chart &chart)
    {
      return chart.surfaces.size() + 1;
    }


    using Edge = std::array<double, 6>; // its ends, in their order

    Edge
    edge(const Triangulation<3>::line_iterator &line)
    {
      Edge            result;
      constexpr auto  n = Point<3>::dimension;
      const Point<3> &a = line->vertex(0), &b = line->vertex(1);
      for (unsigned int d = 0; d < n; ++d)
        {
          result[d]     = a[d];
          result[n + d] = b[d];
        }
      const auto middle = result.begin() + n;
      if (std::lexicographical_compare(
            middle, result.end(), result.begin(), middle))
        std::rotate(result.begin(), middle, result.end());
      return result;
    }


    // Coarse edges before fine ones, since an edge with a hanging vertex may
    // end at hanging vertices itself. Returns which vertices were moved.
    std::vector<bool>
    move_hanging_vertices(const Triangulation<3> &triangulation,
                          std::vector<Point<3>>  &places)
    {
      std::vector<bool> is_hanging(places.size());
      const auto move = [&](const unsigned int vertex, const auto &parent) {
        is_hanging[vertex] = true;
        places[vertex]     = Point<3>();
        for (const unsigned int v : parent->vertex_indices())
          places[vertex] += places[parent->vertex_index(v)] /
                            static_cast<double>(parent->n_vertices());
      };
      for (unsigned int level = 0; level < triangulation.n_levels(); ++level)
        for (const auto &cell :
             triangulation.active_cell_iterators_on_level(level))
          if (!cell->is_artificial())
            {
              for (const unsigned int line : cell->line_indices())
                if (cell->line(line)->has_children())
                  move(cell->line(line)->child(0)->vertex_index(1),
                       cell->line(line));
              for (const unsigned int face : cell->face_indices())
                if (cell->face(face)->has_children())
                  move(cell->face(face)->child(0)->vertex_index(3),
                       cell->face(face));
            }
      return is_hanging;
    }
  } // namespace


  void
  attach_surfaces(const CoarseMesh::Chart &chart,
                  Triangulation<3>        &triangulation)
  {
    for (unsigned int i = 0; i < chart.surfaces.size(); ++i)
      triangulation.set_manifold(manifold_of_surface(i),
                                 CurvedSurface(chart.surfaces[i].onto));
    if (chart.onto_edge)
      triangulation.set_manifold(manifold_of_edges(chart),
                                 CurvedSurface(chart.onto_edge));
  }


  void
  mark_surfaces(const CoarseMesh::Chart &chart, Triangulation<3> &triangulation)
  {
    // surface and face
    std::vector<std::vector<std::pair<unsigned int, unsigned int>>> faces(
      triangulation.n_cells());
    for (unsigned int i = 0; i < chart.surfaces.size(); ++i)
      for (const CoarseMesh::Face &face : chart.surfaces[i].faces)
        faces[face.cell].emplace_back(i, face.face);
    const auto for_each_face = [&](const auto &visit) {
      for (const auto &cell : triangulation.cell_iterators())
        for (const auto &[surface, face] : faces[cell->index()])
          visit(cell->face(face), manifold_of_surface(surface));
    };

    // by the places of their ends, since the sides of an interface have edges
    // of their own
    std::map<Edge, types::manifold_id> edges;
    for_each_face([&](const auto &face, const auto id) {
      for (const unsigned int line : face->line_indices())
        if (auto &of_edge =
              edges.try_emplace(edge(face->line(line)), id).first->second;
            of_edge != id)
          of_edge = manifold_of_edges(chart);
    });
    for_each_face([&](const auto &face, const auto id) {
      face->set_manifold_id(id);
      for (const unsigned int line : face->line_indices())
        face->line(line)->set_manifold_id(edges.at(edge(face->line(line))));
    });
  }


  std::vector<Point<3>>
  positions(const Triangulation<3>  &triangulation,
            const CoarseMesh::Chart &chart)
  {
    std::vector<Point<3>> result = triangulation.get_vertices();
    if (chart.vertices.empty())
      return result;
    std::vector<unsigned int> order;
    for (unsigned int v = 0; v < result.size(); ++v)
      if (triangulation.vertex_used(v))
        order.push_back(v);
    const auto line = [&](const unsigned int v) {
      return std::make_tuple(result[v][0], result[v][2], result[v][1]);
    };
    std::sort(order.begin(), order.end(), [&](const auto a, const auto b) {
      return line(a) < line(b);
    });
    std::vector<Point<3>> coordinates;
    for (const unsigned int v : order)
      coordinates.push_back(result[v]);
    const auto places = chart.positions(coordinates);
    for (std::size_t i = 0; i < order.size(); ++i)
      result[order[i]] = places[i];
    return result;
  }


  void
  place_vertices(const CoarseMesh::Chart                   &chart,
                 parallel::DistributedTriangulationBase<3> &triangulation)
  {
    if (chart.vertices.empty())
      return;
    std::vector<Point<3>> places = positions(triangulation, chart);
    std::vector<bool>     moved  = move_hanging_vertices(triangulation, places);
    for (const auto &cell : triangulation.cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        cell->vertex(v) = places[cell->vertex_index(v)];
    // a ghost cell's neighbours are not all known here
    const auto owned = GridTools::get_locally_owned_vertices(triangulation);
    std::transform(moved.begin(),
                   moved.end(),
                   owned.begin(),
                   moved.begin(),
                   std::logical_and<bool>());
    triangulation.communicate_locally_moved_vertices(moved);
    triangulation.set_all_manifold_ids(numbers::flat_manifold_id);
    triangulation.reset_all_manifolds();
  }
} // namespace Voussoir
