#include <voussoir/fem/nodal_terms.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    Tensor<1, 3>
    read(const Vector &vector, const unsigned int node)
    {
      Tensor<1, 3> value;
      for (unsigned int d = 0; d < 3; ++d)
        value[d] = vector.local_element(3 * node + d);
      return value;
    }
  } // namespace


  unsigned int
  NodalTerms::add_node(const unsigned int node)
  {
    const auto [place, is_new] = slot_of_node.emplace(node, nodes.size());
    if (is_new)
      {
        nodes.push_back(node);
        springs.emplace_back();
        dashpots.emplace_back();
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
        masses[slot] = read(mass.mass, nodes[slot]);
        if (central)
          masses[slot] *= 1. + 0.5 * time_step * mass_coefficient;
        // a held component keeps its zero velocity: unit row and column
        Tensor<2, 3> matrix;
        for (unsigned int d = 0; d < 3; ++d)
          for (unsigned int e = 0; e < 3; ++e)
            {
              if (masses[slot][d] > 0. && masses[slot][e] > 0. && central)
                matrix[d][e] = 0.5 * time_step * dashpots[slot][d][e];
              if (d == e)
                matrix[d][e] += masses[slot][d] > 0. ? masses[slot][d] : 1.;
            }
        inverse[slot] = invert(matrix);
      }
  }


  void
  NodalTerms::before_step(const Vector &displacement, const Vector &velocity)
  {
    for (unsigned int slot = 0; slot < nodes.size(); ++slot)
      {
        last_displacement[slot] = read(displacement, nodes[slot]);
        last_velocity[slot]     = read(velocity, nodes[slot]);
      }
  }


  void
  NodalTerms::correct(Vector &displacement, Vector &velocity)
  {
    const double lag = central ? 0.5 * time_step : time_step;
    for (unsigned int slot = 0; slot < nodes.size(); ++slot)
      {
        const unsigned int node = nodes[slot];
        Tensor<1, 3>       momentum =
          time_step * (forces[slot] - springs[slot] * last_displacement[slot]) -
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
        work_of_forces += time_step * (forces[slot] * mean);
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


  double
  NodalTerms::spring_energy(const Vector &displacement,
                            const Vector &velocity) const
  {
    double sum = 0.;
    for (unsigned int slot = 0; slot < nodes.size(); ++slot)
      {
        const Tensor<1, 3> u = read(displacement, nodes[slot]);
        const Tensor<1, 3> previous =
          u - time_step * read(velocity, nodes[slot]);
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
        const Tensor<1, 3> u = read(displacement, nodes[slot]);
        const Tensor<1, 3> f =
          springs[slot] * u + dashpot_factor * (dashpots[slot] * u);
        for (unsigned int d = 0; d < 3; ++d)
          force.local_element(3 * nodes[slot] + d) += f[d];
      }
  }
} // namespace Voussoir
