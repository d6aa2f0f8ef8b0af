#ifndef voussoir_constraints_contact_clusters_h
#define voussoir_constraints_contact_clusters_h

#include <voussoir/fem/discretization.h>

namespace Voussoir
{
  /** Two coincident nodes on the two sides of an interface. */
  struct ContactPair
  {
    unsigned int         interface;     // which one
    unsigned int         first, second; // numbers in the cluster's nodes
    dealii::Tensor<1, 3> normal;        // unit, from the first to the second
    double               area;          // tributary [m2]

    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &interface &first &second &normal &area;
    }
  };

  /** All coincident nodes of one point, and the interfaces between them. */
  struct ContactCluster
  {
    std::uint64_t    key;      // the same on all partitions
    dealii::Point<3> position; // [m]
    std::vector<dealii::types::global_dof_index> nodes; // global nodes
    std::vector<ContactPair>                     pairs;

    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &key &position &nodes &pairs;
    }
  };

  /**
   * The clusters of the interfaces of a mesh that was split along them (see
   * mesh/interfaces.h). Each cluster belongs to one rank, which is the owner of
   * its first node. The nodes of a cluster, its pairs and the clusters of a
   * rank are in an order that does not depend on ranks and partition.
   *
   * Areas and normals are those of the reference configuration, by nodal
   * quadrature: the areas of an interface's pairs sum up to its area, and a
   * pair's normal is the mean over its area. Where an interface ends inside the
   * body its two sides share one node, which makes no pair.
   *
   * A hanging node in an interface makes no pair: its gap is the mean of those
   * of the nodes that constrain it, which take its area.
   *
   * Throws UserError, on all ranks, if a node has no partner on the other side,
   * or hangs between cells of degree above one.
   */
  std::vector<ContactCluster>
  find_contact_clusters(const Discretization           &discretization,
                        const std::vector<std::string> &interfaces);
} // namespace Voussoir

#endif
