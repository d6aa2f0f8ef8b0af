#include <voussoir/constraints/contact_exchange.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;

  ContactExchange::ContactExchange(
    const Discretization                       &discretization,
    const std::vector<types::global_dof_index> &cluster_nodes)
  {
    const IndexSet &mine         = discretization.owned_dofs;
    const MPI_Comm  communicator = discretization.grid.communicator();
    const auto      with_ghosts = [&](const IndexSet &own, const auto &number) {
      IndexSet ghosts(own.size());
      for (unsigned int i = 0; i < cluster_nodes.size(); ++i)
        if (!mine.is_element(3 * cluster_nodes[i]))
          ghosts.add_range(number(i), number(i) + 3);
      ghosts.compress();
      return std::make_shared<Utilities::MPI::Partitioner>(own,
                                                           ghosts,
                                                           communicator);
    };
    const auto all = with_ghosts(mine, [&](const unsigned int i) {
      return 3 * cluster_nodes[i];
    });
    std::vector<unsigned int> nodes_lent;
    for (const auto &[begin, end] : all->import_indices())
      for (unsigned int i = begin; i < end; ++i)
        if (i % 3 == 0)
          nodes_lent.push_back(i / 3);
    owned = nodes_lent;
    for (const auto node : cluster_nodes)
      if (mine.is_element(3 * node))
        owned.push_back(all->global_to_local(3 * node) / 3);
    std::sort(owned.begin(), owned.end());
    owned.erase(std::unique(owned.begin(), owned.end()), owned.end());

    // a vector of the nodes that other ranks use, with one entry more, since
    // deal.II admits no vector without entries
    const types::global_dof_index n_entries = 3 * nodes_lent.size() + 1;
    types::global_dof_index       first     = 0;
    MPI_Exscan(
      &n_entries, &first, 1, DEAL_II_DOF_INDEX_MPI_TYPE, MPI_SUM, communicator);
    IndexSet own(Utilities::MPI::sum(n_entries, communicator));
    own.add_range(first, first + n_entries);
    Vector numbers(all);
    for (unsigned int i = 0; i < nodes_lent.size(); ++i)
      numbers.local_element(3 * nodes_lent[i]) = first + 3 * i;
    numbers.update_ghost_values();
    const auto number = [&](const unsigned int i) {
      return static_cast<types::global_dof_index>(
        numbers.local_element(all->global_to_local(3 * cluster_nodes[i])));
    };
    const auto partitioner = with_ghosts(own, number);
    shared.reinit(partitioner);

    const auto place_of = [&](const unsigned int node) -> unsigned int {
      return std::lower_bound(owned.begin(), owned.end(), node) - owned.begin();
    };
    for (const unsigned int node : nodes_lent)
      lent.push_back(place_of(node));
    for (unsigned int i = 0; i < cluster_nodes.size(); ++i)
      if (mine.is_element(3 * cluster_nodes[i]))
        here.push_back(
          {i, place_of(all->global_to_local(3 * cluster_nodes[i]) / 3)});
      else
        remote.push_back({i, partitioner->global_to_local(number(i))});
  }


  const std::vector<unsigned int> &
  ContactExchange::owned_nodes() const
  {
    return owned;
  }


  template <typename Value>
  void
  ContactExchange::bring(const Value               &value_at_owned,
                         std::vector<Tensor<1, 3>> &at_cluster_nodes)
  {
    for (const auto &[cluster_node, place] : here)
      at_cluster_nodes[cluster_node] = value_at_owned(place);
    for (unsigned int i = 0; i < lent.size(); ++i)
      {
        const Tensor<1, 3> value = value_at_owned(lent[i]);
        for (unsigned int d = 0; d < 3; ++d)
          shared.local_element(3 * i + d) = value[d];
      }
    shared.update_ghost_values();
    for (const auto &[cluster_node, entry] : remote)
      for (unsigned int d = 0; d < 3; ++d)
        at_cluster_nodes[cluster_node][d] = shared.local_element(entry + d);
    shared.zero_out_ghost_values();
  }


  void
  ContactExchange::to_clusters(const Vector              &values,
                               std::vector<Tensor<1, 3>> &at_cluster_nodes)
  {
    const double *first = values.begin();
    bring(
      [&](const unsigned int place) {
        const double *x = first + 3 * owned[place];
        return Point<3>(x[0], x[1], x[2]);
      },
      at_cluster_nodes);
  }


  void
  ContactExchange::to_clusters(const std::vector<Tensor<1, 3>> &at_owned_nodes,
                               std::vector<Tensor<1, 3>> &at_cluster_nodes)
  {
    bring([&](const unsigned int place) { return at_owned_nodes[place]; },
          at_cluster_nodes);
  }


  void
  ContactExchange::to_owners(const std::vector<Tensor<1, 3>> &at_cluster_nodes,
                             std::vector<Tensor<1, 3>>       &at_owned_nodes)
  {
    for (const auto &[cluster_node, place] : here)
      at_owned_nodes[place] = at_cluster_nodes[cluster_node];
    shared = 0.;
    // each node is in one cluster
    for (const auto &[cluster_node, entry] : remote)
      for (unsigned int d = 0; d < 3; ++d)
        shared.local_element(entry + d) = at_cluster_nodes[cluster_node][d];
    shared.compress(VectorOperation::add);
    for (unsigned int i = 0; i < lent.size(); ++i)
      for (unsigned int d = 0; d < 3; ++d)
        at_owned_nodes[lent[i]][d] = shared.local_element(3 * i + d);
  }


  void
  ContactExchange::add(Vector                          &vector,
                       const double                     factor,
                       const std::vector<Tensor<1, 3>> &at_owned_nodes) const
  {
    for (unsigned int i = 0; i < owned.size(); ++i)
      for (unsigned int d = 0; d < 3; ++d)
        vector.local_element(3 * owned[i] + d) += factor * at_owned_nodes[i][d];
  }
} // namespace Voussoir
