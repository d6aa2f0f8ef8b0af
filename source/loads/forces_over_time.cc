#include <voussoir/loads/forces_over_time.h>

namespace Voussoir
{
  using namespace dealii;

  ForcesOverTime::ForcesOverTime(const std::string &expression)
    : factor(expression)
  {}


  std::vector<unsigned int>
  ForcesOverTime::nodes() const
  {
    std::vector<unsigned int> list;
    for (const auto &item : nodal_forces)
      list.push_back(item.first);
    return list;
  }


  void
  ForcesOverTime::add_forces(const double time, NodalForces &forces) const
  {
    if (nodal_forces.empty())
      return;
    const double now = factor(time);
    for (const auto &[node, force] : nodal_forces)
      forces.add(node, now * force);
  }
} // namespace Voussoir
