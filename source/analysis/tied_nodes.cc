#include <voussoir/analysis/tied_nodes.h>
#include <voussoir/base/mpi.h>

#include <numeric>
#include <set>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    using Nodes = std::vector<types::global_dof_index>;


    /** Followers and leaders among the clusters of this rank. */
    std::vector<std::pair<types::global_dof_index, types::global_dof_index>>
    groups(const Contact                                   &contact,
           const std::function<bool(const ContactPoint &)> &is_tied)
    {
      const Nodes              &nodes = contact.cluster_nodes();
      std::vector<unsigned int> before(nodes.size());
      std::iota(before.begin(), before.end(), 0);
      const auto first_of = [&](unsigned int i) {
        while (before[i] != i)
          i = before[i];
        return i;
      };
      for (const ContactPoint &point : contact.points())
        if (is_tied(point))
          {
            const unsigned int a   = first_of(point.first),
                               b   = first_of(point.second);
            before[std::max(a, b)] = std::min(a, b);
          }
      std::vector<std::pair<types::global_dof_index, types::global_dof_index>>
        result;
      for (unsigned int i = 0; i < nodes.size(); ++i)
        if (before[i] != i)
          result.emplace_back(nodes[i], nodes[first_of(i)]);
      return result;
    }
  } // namespace


  TiedNodes::TiedNodes(const Discretization &discretization,
                       const Contact        &contact,
                       const std::function<bool(const ContactPoint &)> &is_tied)
    : discretization(discretization)
  {
    const IndexSet &owned        = discretization.owned_dofs;
    const MPI_Comm  communicator = discretization.grid.communicator();
    IndexSet        needed(owned.size());
    std::set<types::global_dof_index> leading;
    for (const auto &[follower, leader] :
         join_over_ranks(groups(contact, is_tied), communicator))
      {
        leader_of[follower] = leader;
        leading.insert(leader);
        if (owned.is_element(3 * follower) && !owned.is_element(3 * leader))
          needed.add_range(3 * leader, 3 * leader + 3);
      }
    shared.reinit(owned, needed, communicator);
    const auto entry = [&](const types::global_dof_index node) {
      return shared.get_partitioner()->global_to_local(3 * node);
    };
    for (const auto &[follower, leader] : leader_of)
      if (owned.is_element(3 * follower))
        followers.push_back({entry(follower), entry(leader)});
    for (const auto leader : leading)
      if (owned.is_element(3 * leader))
        leaders.push_back(entry(leader));
  }


  AffineConstraints<double>
  TiedNodes::added_to(const AffineConstraints<double> &constraints) const
  {
    // components in which any node of a group is constrained
    const IndexSet                      &owned = discretization.owned_dofs;
    std::set<types::global_dof_index>    constrained;
    std::vector<types::global_dof_index> mine;
    const auto collect = [&](const types::global_dof_index node,
                             const types::global_dof_index leader) {
      for (unsigned int d = 0; d < 3; ++d)
        if (owned.is_element(3 * node) &&
            constraints.is_constrained(3 * node + d))
          mine.push_back(3 * leader + d);
    };
    for (const auto &[follower, leader] : leader_of)
      {
        collect(follower, leader);
        collect(leader, leader);
      }
    for (const auto dof :
         join_over_ranks(mine, discretization.grid.communicator()))
      constrained.insert(dof);

    IndexSet lines = discretization.relevant_dofs;
    for (const auto &[follower, leader] : leader_of)
      if (discretization.relevant_dofs.is_element(3 * follower))
        lines.add_range(3 * leader, 3 * leader + 3);
    AffineConstraints<double> result(lines);
    for (const auto &line : constraints.get_lines())
      if (leader_of.count(line.index / 3) == 0)
        {
          result.add_line(line.index);
          result.add_entries(line.index, line.entries);
        }
    for (const auto &[follower, leader] : leader_of)
      for (unsigned int d = 0; d < 3; ++d)
        if (lines.is_element(3 * follower))
          {
            result.add_line(3 * follower + d);
            if (constrained.count(3 * leader + d) == 0)
              result.add_entry(3 * follower + d, 3 * leader + d, 1.);
          }
    for (const auto dof : constrained)
      if (lines.is_element(dof) && !result.is_constrained(dof))
        result.add_line(dof);
    result.close();
    return result;
  }


  void
  TiedNodes::distribute(Vector &displacement) const
  {
    for (const unsigned int leader : leaders)
      for (unsigned int d = 0; d < 3; ++d)
        shared.local_element(leader + d) =
          displacement.local_element(leader + d);
    shared.update_ghost_values();
    for (const auto &[entry, leader] : followers)
      for (unsigned int d = 0; d < 3; ++d)
        displacement.local_element(entry + d) =
          shared.local_element(leader + d);
    shared.zero_out_ghost_values();
  }


  void
  TiedNodes::collect(Vector &force) const
  {
    for (const unsigned int leader : leaders)
      for (unsigned int d = 0; d < 3; ++d)
        shared.local_element(leader + d) = 0.;
    for (const auto &[entry, leader] : followers)
      for (unsigned int d = 0; d < 3; ++d)
        {
          shared.local_element(leader + d) += force.local_element(entry + d);
          force.local_element(entry + d) = 0.;
        }
    shared.compress(VectorOperation::add);
    for (const unsigned int leader : leaders)
      for (unsigned int d = 0; d < 3; ++d)
        force.local_element(leader + d) += shared.local_element(leader + d);
  }
} // namespace Voussoir
