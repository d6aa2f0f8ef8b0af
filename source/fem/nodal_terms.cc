#include <voussoir/fem/nodal_terms.h>
#include <voussoir/fem/nodal_values.h>

#include <numeric>

namespace Voussoir
{
  using namespace dealii;

  NodalTerms::NodalTerms(const unsigned int n_owned_nodes)
    : slot_of_node(n_owned_nodes, numbers::invalid_unsigned_int)
  {}


  unsigned int
  NodalTerms::slot_made_at(const unsigned int node)
  {
    unsigned int &slot = slot_of_node[node];
    if (slot == numbers::invalid_unsigned_int)
      {
        slot = nodes.size();
        nodes.push_back(node);
        springs.emplace_back();
        dashpots.emplace_back();
        added_mass.emplace_back();
      }
    return slot;
  }


  void
  NodalTerms::add(const std::vector<NodalTerm> &terms)
  {
    for (const NodalTerm &term : terms)
      {
        const unsigned int slot = slot_made_at(term.node);
        springs[slot] += term.spring;
        dashpots[slot] += term.dashpot;
        added_mass[slot] += term.added_mass;
      }
  }


  void
  NodalTerms::add_nodes(const std::vector<unsigned int> &nodes)
  {
    for (const unsigned int node : nodes)
      slot_made_at(node);
  }


  std::optional<unsigned int>
  NodalTerms::slot_at(const unsigned int node) const
  {
    if (slot_of_node[node] == numbers::invalid_unsigned_int)
      return {};
    return slot_of_node[node];
  }


  Sum
  NodalTerms::kinetic_energy(const Vector &velocity, const bool exact) const
  {
    Sum sum(exact);
    for (unsigned int slot = 0; slot < nodes.size(); ++slot)
      {
        const Tensor<1, 3> v = node_value(velocity, nodes[slot]);
        sum += 0.5 * (v * (added_mass[slot] * v));
      }
    return sum;
  }


  Sum
  NodalTerms::spring_energy(const Vector &displacement,
                            const Vector &velocity,
                            const double  time_step,
                            const bool    exact) const
  {
    Sum sum(exact);
    for (unsigned int slot = 0; slot < nodes.size(); ++slot)
      {
        const Tensor<1, 3> u = node_value(displacement, nodes[slot]),
                           v = node_value(velocity, nodes[slot]);
        sum += 0.5 * (u * (springs[slot] * (u - time_step * v)));
      }
    return sum;
  }


  void
  NodalTerms::add_to(Vector       &force,
                     const Vector &displacement,
                     const double  dashpot_factor) const
  {
    for (unsigned int slot = 0; slot < nodes.size(); ++slot)
      {
        const Tensor<1, 3> u = node_value(displacement, nodes[slot]);
        const Tensor<1, 3> f =
          springs[slot] * u + dashpot_factor * (dashpots[slot] * u);
        for (unsigned int d = 0; d < 3; ++d)
          force.local_element(3 * nodes[slot] + d) += f[d];
      }
  }


  NodalForces::NodalForces(const NodalTerms &terms)
    : slots(terms.slot_of_node)
    , values(terms.nodes.size())
  {}


  void
  NodalForces::reset()
  {
    std::fill(values.begin(), values.end(), Tensor<1, 3>());
  }


  Tensor<1, 3>
  NodalForces::sum() const
  {
    return std::accumulate(values.begin(), values.end(), Tensor<1, 3>());
  }
} // namespace Voussoir
