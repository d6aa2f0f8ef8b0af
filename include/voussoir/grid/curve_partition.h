#ifndef voussoir_grid_curve_partition_h
#define voussoir_grid_curve_partition_h

#include <voussoir/mesh/coarse_mesh.h>

#include <deal.II/grid/tria_description.h>

namespace Voussoir
{
  /** Numbers the cells of a mesh in the order in which a Hilbert curve passes
   *  their centres. */
  void
  order_along_curve(CoarseMesh &mesh);

  /** The ranks of cells of these costs, of which each rank gets a sequence of
   *  about the same cost. */
  std::vector<dealii::types::subdomain_id>
  ranks_along_curve(const std::vector<double> &costs,
                    const unsigned int         n_ranks);

  /**
   * This rank's part of a mesh that is not refined, and the cells around it, in
   * the order of the mesh. The first rank of each machine sends the others
   * their parts; only it needs mesh, tags and costs.
   *
   * @param tags and @p costs of the cells
   */
  dealii::TriangulationDescription::Description<3, 3>
  part_along_curve(const CoarseMesh                              &mesh,
                   const std::vector<dealii::types::material_id> &tags,
                   const std::vector<double>                     &costs,
                   const MPI_Comm                                 communicator);
} // namespace Voussoir

#endif
