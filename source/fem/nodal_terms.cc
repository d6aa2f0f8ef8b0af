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
        forces.emplace_back();
      }
    return place->second;
  }


  void
  NodalTerms::prepare(const LumpedMass &mass,
                      const double      mass_coefficient,
                      const double      step,
                      const bool        treat_centrally)
  {
    time_step = step;
    central   = treat_centrally;
    masses.resize(nodes.size());
    inverse.resize(nodes.size());
    last_displacement.resize(nodes.size());
    last_velocity.resize(nodes.size());
    for (unsigned int slot = 0; slot < nodes.size(); ++slot)
      {
        masses[slot] = node_value(mass.mass, nodes[slot]);
        if (central)
          masses[slot] *= 1. + 0.5 * time_step * mass_coefficient;
        // a held component keeps its zero velocity: unit row and column
        Tensor<2, 3> matrix;
        for (unsigned int d = 0; d < 3; ++d)
          for (unsigned int e = 0; e < 3; ++e)
            {
              if (masses[slot][d] > 0. && masses[slot][e] > 0.)
                matrix[d][e] =
                  added_mass[slot][d][e] +
                  (central ? 0.5 * time_step * dashpots[slot][d][e] : 0.);
              if (d == e)
                matrix[d][e] += masses[slot][d] > 0. ? masses[slot][d] : 1.;
            }
        inverse[slot] = invert(matrix);
      }
  }


  void
  NodalTerms::before_step(const Vector       &displacement,
                          const Vector       &velocity,
                          const Tensor<1, 3> &base_acceleration)
  {
    base = base_acceleration;
    for (unsigned int slot = 0; slot < nodes.size(); ++slot)
      {
        last_displacement[slot] = node_value(displacement, nodes[slot]);
        last_velocity[slot]     = node_value(velocity, nodes[slot]);
      }
  }


  void
  NodalTerms::correct(Vector &displacement, Vector &velocity)
  {
    const double lag = central ? 0.5 * time_step : time_step;
    for (unsigned int slot = 0; slot < nodes.size(); ++slot)
      {
        const unsigned int node = nodes[slot];
        // what drives the added mass is the ground under a rigid base
        const Tensor<1, 3> applied = forces[slot] - added_mass[slot] * base;
        Tensor<1, 3>       momentum =
          added_mass[slot] * last_velocity[slot] +
          time_step * (applied - springs[slot] * last_displacement[slot]) -
          lag * (dashpots[slot] * last_velocity[slot]);
        for (unsigned int d = 0; d < 3; ++d)
          {
            momentum[d] +=
              masses[slot][d] * velocity.local_element(3 * node + d);
            if (masses[slot][d] == 0.)
              momentum[d] = 0.;
          }
        const Tensor<1, 3> next = inverse[slot] * momentum;
        const Tensor<1, 3> mean = 0.5 * (next + last_velocity[slot]);
        work_of_forces += time_step * (applied * mean);
        loss_in_dashpots +=
          time_step *
          (mean * (dashpots[slot] * (central ? mean : last_velocity[slot])));
        for (unsigned int d = 0; d < 3; ++d)
          {
            velocity.local_element(3 * node + d) = next[d];
            displacement.local_element(3 * node + d) =
              last_displacement[slot][d] + time_step * next[d];
          }
      }
  }


  std::optional<unsigned int>
  NodalTerms::slot_at(const unsigned int node) const
  {
    const auto slot = slot_of_node.find(node);
    if (slot == slot_of_node.end())
      return {};
    return slot->second;
  }


  std::optional<Tensor<2, 3>>
  NodalTerms::inverse_at(const unsigned int node) const
  {
    const auto slot = slot_at(node);
    if (!slot)
      return {};
    Tensor<2, 3> result = inverse[*slot];
    for (unsigned int d = 0; d < 3; ++d)
      if (masses[*slot][d] == 0.)
        result[d][d] = 0.;
    return result;
  }


  void
  NodalTerms::account_for(const unsigned int  slot,
                          const Tensor<1, 3> &velocity,
                          const Tensor<1, 3> &change)
  {
    const Tensor<1, 3> applied = forces[slot] - added_mass[slot] * base;
    const Tensor<1, 3> mean    = 0.5 * (velocity + last_velocity[slot]),
                       was     = mean - 0.5 * change;
    work_of_forces += time_step * (applied * (mean - was));
    // with the paper's scheme dashpots act on the velocity before the step
    const Tensor<1, 3> &v = last_velocity[slot];
    loss_in_dashpots +=
      time_step * (mean * (dashpots[slot] * (central ? mean : v)) -
                   was * (dashpots[slot] * (central ? was : v)));
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
                            const Vector &velocity) const
  {
    double sum = 0.;
    for (unsigned int slot = 0; slot < nodes.size(); ++slot)
      {
        const Tensor<1, 3> u = node_value(displacement, nodes[slot]);
        const Tensor<1, 3> previous =
          u - time_step * node_value(velocity, nodes[slot]);
        sum += 0.5 * (u * (springs[slot] * previous));
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
} // namespace Voussoir
