#include <voussoir/fem/nodal_terms.h>
#include <voussoir/fem/nodal_values.h>

namespace Voussoir
{
  using namespace dealii;

  unsigned int
  NodalTerms::add_node(const unsigned int node)
  {
    const auto [place, is_new] = slot_of_node.emplace(node, nodes.size());
    if (is_new)
      {
        nodes.push_back(node);
        springs.emplace_back();
        dashpots.emplace_back();
        added_mass.emplace_back();
      }
    return place->second;
  }


  std::optional<unsigned int>
  NodalTerms::slot_at(const unsigned int node) const
  {
    const auto slot = slot_of_node.find(node);
    if (slot == slot_of_node.end())
      return {};
    return slot->second;
  }


  double
  NodalTerms::kinetic_energy(const Vector &velocity) const
  {
    double sum = 0.;
    for (unsigned int slot = 0; slot < nodes.size(); ++slot)
      {
        const Tensor<1, 3> v = node_value(velocity, nodes[slot]);
        sum += 0.5 * (v * (added_mass[slot] * v));
      }
    return sum;
  }


  double
  NodalTerms::spring_energy(const Vector &displacement,
                            const Vector &previous) const
  {
    double sum = 0.;
    for (unsigned int slot = 0; slot < nodes.size(); ++slot)
      sum += 0.5 * (node_value(displacement, nodes[slot]) *
                    (springs[slot] * node_value(previous, nodes[slot])));
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
} // namespace Voussoir
