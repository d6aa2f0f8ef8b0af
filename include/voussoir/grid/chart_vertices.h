#ifndef voussoir_grid_chart_vertices_h
#define voussoir_grid_chart_vertices_h

#include <voussoir/mesh/coarse_mesh.h>

#include <deal.II/distributed/tria_base.h>

#include <vector>

namespace Voussoir
{
  /** Manifold of the faces on a curved surface of a chart. */
  constexpr dealii::types::manifold_id curved_surface = 1;

  void
  attach_curved_surface(const CoarseMesh::Chart  &chart,
                        dealii::Triangulation<3> &triangulation);

  /** Places in space of a triangulation's vertices, by their index. */
  std::vector<dealii::Point<3>>
  positions(const dealii::Triangulation<3> &triangulation,
            const CoarseMesh::Chart        &chart);

  /** Moves vertices from the coordinates of the chart into space. The
   *  triangulation must not be refined afterwards. */
  void
  place_vertices(
    const CoarseMesh::Chart                           &chart,
    dealii::parallel::DistributedTriangulationBase<3> &triangulation);
} // namespace Voussoir

#endif
