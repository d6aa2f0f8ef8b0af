#ifndef voussoir_grid_partition_counts_h
#define voussoir_grid_partition_counts_h

#include <voussoir/grid/grid.h>

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

    /** A line for the log. */
    std::string
    describe() const;
  };

  /**
   * Distributes the cells as p4est does, in the order of its trees and by their
   * cost, and counts the nodes that ranks share, without starting these ranks.
   * Nodes are those of degree 1; each belongs to the first rank that has a cell
   * there; other ranks exchange its values with this rank. All ranks must call
   * this together.
   *
   * @param cost of a cell, as for the balance of ranks
   */
  PartitionCounts
  count_partition(const Grid                                      &grid,
                  const std::function<double(const Grid::Cell &)> &cost,
                  const unsigned int                               n_ranks);
} // namespace Voussoir

#endif
