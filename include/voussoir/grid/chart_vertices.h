#ifndef voussoir_grid_chart_vertices_h
#define voussoir_grid_chart_vertices_h

#include <voussoir/mesh/coarse_mesh.h>

#include <deal.II/distributed/tria_base.h>

#include <vector>

namespace Voussoir
{
  /** Attaches manifolds for the curved surfaces of a chart. */
  void
  attach_surfaces(const CoarseMesh::Chart  &chart,
                  dealii::Triangulation<3> &triangulation);

  /** Marks the faces and edges of a coarse triangulation that lie on them. */
  void
  mark_surfaces(const CoarseMesh::Chart  &chart,
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
