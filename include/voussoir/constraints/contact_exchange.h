#ifndef voussoir_constraints_contact_exchange_h
#define voussoir_constraints_contact_exchange_h

#include <voussoir/constraints/contact_clusters.h>

namespace Voussoir
{
  /**
   * Transfers the motion of nodes to the ranks that own their contact clusters,
   * and the forces back, by one message to each neighbour that shares clusters.
   */
  class ContactExchange
  {
  public:
    /** @param cluster_nodes global nodes of all clusters of this rank */
    ContactExchange(
      const Discretization                               &discretization,
      const std::vector<dealii::types::global_dof_index> &cluster_nodes);

    /** Owned nodes that are in a cluster of any rank, in ascending order. */
    const std::vector<unsigned int> &
    owned_nodes() const;

    /** Values at the nodes of the clusters. */
    void
    to_clusters(const Vector                      &values,
                std::vector<dealii::Tensor<1, 3>> &at_cluster_nodes);

    void
    to_clusters(const std::vector<dealii::Tensor<1, 3>> &at_owned_nodes,
                std::vector<dealii::Tensor<1, 3>>       &at_cluster_nodes);

    /** Values at the owned nodes from those at the nodes of the clusters. */
    void
    to_owners(const std::vector<dealii::Tensor<1, 3>> &at_cluster_nodes,
              std::vector<dealii::Tensor<1, 3>>       &at_owned_nodes);

    /** vector += factor * values. */
    void
    add(Vector                                  &vector,
        const double                             factor,
        const std::vector<dealii::Tensor<1, 3>> &at_owned_nodes) const;

  private:
    template <typename Value>
    void
    bring(const Value                       &value_at_owned,
          std::vector<dealii::Tensor<1, 3>> &at_cluster_nodes);

    std::vector<unsigned int> owned;

    // Each owned node is in a cluster of this rank or of another one.
    struct Place
    {
      unsigned int cluster_node, place;
    };
    std::vector<Place>        here;   // index among the owned nodes
    std::vector<Place>        remote; // entry of its x in the vector
    std::vector<unsigned int> lent;   // owned nodes in clusters elsewhere

    Vector shared; // of the nodes lent
  };
} // namespace Voussoir

#endif
