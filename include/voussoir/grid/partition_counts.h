#ifndef voussoir_grid_partition_counts_h
#define voussoir_grid_partition_counts_h

#include <voussoir/mesh/coarse_mesh.h>

#include <deal.II/distributed/tria_base.h>

#include <functional>
#include <string>
#include <vector>

namespace Voussoir
{
  /** Size of the exchange between ranks if a mesh were distributed to a given
   *  number of ranks. */
  struct PartitionCounts
  {
    unsigned int ranks;

    /** The largest cost of the cells of a rank over the mean one. */
    double balance;

    /** Neighbours of a rank, mean and largest number; nodes that it receives or
     *  sends, mean and largest number. */
    double       neighbours, nodes;
    unsigned int most_neighbours, most_nodes;

    /** Part of a rank's cells that have none of these nodes, mean and least. */
    double inner, least_inner;

    /** A line for the log. */
    std::string
    describe() const;
  };

  /**
   * Divides the cells as p4est does, in the order of its trees and by their
   * cost, and counts the nodes that ranks share, without starting these ranks.
   * Nodes are those of degree 1; each belongs to the first rank that has a cell
   * there; other ranks exchange its values with this rank. All ranks must call
   * this together.
   *
   * @param cost of a cell, as for the balance of ranks
   */
  PartitionCounts
  count_by_p4est(
    const dealii::parallel::DistributedTriangulationBase<3> &mesh,
    const std::function<double(const dealii::Triangulation<3>::cell_iterator &)>
                      &cost,
    const unsigned int n_ranks);

  /** The same for a mesh divided along a Hilbert curve, in whose order its
   *  cells stand; only the first rank needs mesh and costs. */
  PartitionCounts
  count_along_curve(const CoarseMesh          &mesh,
                    const std::vector<double> &costs,
                    const unsigned int         n_ranks,
                    const MPI_Comm             communicator);
} // namespace Voussoir

#endif
