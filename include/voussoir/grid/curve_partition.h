#ifndef voussoir_grid_curve_partition_h
#define voussoir_grid_curve_partition_h

#include <voussoir/mesh/coarse_mesh.h>

#include <deal.II/grid/tria_description.h>

namespace Voussoir
{
  /**
   * This rank's part of a mesh that is not refined, and the cells around it.
   * The cells are dealt to the ranks along a Hilbert curve through their
   * centres, which is also their order on each rank. All ranks have the same
   * mesh.
   *
   * @param tags and @p costs of the cells; all ranks get about the same cost
   */
  dealii::TriangulationDescription::Description<3, 3>
  part_along_curve(const CoarseMesh                              &mesh,
                   const std::vector<dealii::types::material_id> &tags,
                   const std::vector<double>                     &costs,
                   const MPI_Comm                                 communicator);
} // namespace Voussoir

#endif
