#ifndef voussoir_grid_partition_counts_h
#define voussoir_grid_partition_counts_h

#include <deal.II/distributed/tria_base.h>

#include <array>
#include <string>
#include <vector>

namespace Voussoir
{
  /** What the ranks would compute and exchange if a mesh were distributed to a
   *  given number of them; for each of these ranks: */
  struct PartitionCounts
  {
    /** The cost of its cells over the mean one. */
    std::vector<double> load;

    /** The part of its cells without shared nodes. */
    std::vector<double> inner;

    /** Ranks with which it shares nodes, and the nodes that it receives from
     *  them or sends to them. */
    std::vector<unsigned int> neighbours, nodes;

    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &load &inner &neighbours &nodes;
    }

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
   * @param costs of the active cells by their numbers, as for the balance of
   * ranks
   */
  PartitionCounts
  count_by_p4est(const dealii::parallel::DistributedTriangulationBase<3> &mesh,
                 const std::vector<double>                               &costs,
                 const unsigned int n_ranks);

  /** The same for cells whose ranks are known, by the numbers of their
   *  vertices; for one rank of the run. */
  PartitionCounts
  count_partition(const std::vector<std::array<unsigned int, 8>> &cells,
                  const std::vector<dealii::types::subdomain_id> &rank,
                  const std::vector<double>                      &costs,
                  const unsigned int                              n_ranks);
} // namespace Voussoir

#endif
