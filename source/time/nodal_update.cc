#include <voussoir/fem/nodal_values.h>
#include <voussoir/time/nodal_update.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // The added mass of water is part of the mass of the modes, and damped
    // likewise.
    NodalTerms::Matrix
    damping_at(const NodalTerms  &terms,
               const unsigned int slot,
               const double       mass_coefficient)
    {
      return terms.dashpots[slot] + mass_coefficient * terms.added_mass[slot];
    }
  } // namespace


  NodalUpdate::NodalUpdate(const NodalTerms &terms,
                           const LumpedMass &mass,
                           const double      mass_coefficient,
                           const LeapFrog   &leap_frog)
    : terms(terms)
    , mass(mass)
    , mass_coefficient(mass_coefficient)
    , leap_frog(leap_frog)
    , inverse(terms.nodes.size())
    , masses(terms.nodes.size())
    , has_water(terms.nodes.size())
    , applied(terms.nodes.size())
    , last_displacement(terms.nodes.size())
    , last_velocity(terms.nodes.size())
  {
    const double share = leap_frog.implicit_share();
    for (unsigned int slot = 0; slot < terms.nodes.size(); ++slot)
      {
        masses[slot] = node_value(mass.mass, terms.nodes[slot]);
        masses[slot] *= 1. + share * mass_coefficient;
        const NodalTerms::Matrix damping =
          damping_at(terms, slot, mass_coefficient);
        // a fixed component keeps its zero velocity: unit row and column
        Tensor<2, 3> matrix;
        for (unsigned int d = 0; d < 3; ++d)
          for (unsigned int e = 0; e < 3; ++e)
            {
              if (masses[slot][d] > 0. && masses[slot][e] > 0.)
                matrix[d][e] =
                  terms.added_mass[slot][d][e] + share * damping[d][e];
              if (d == e)
                matrix[d][e] += masses[slot][d] > 0. ? masses[slot][d] : 1.;
            }
        inverse[slot]   = invert(matrix);
        has_water[slot] = terms.added_mass[slot].norm() > 0.;
      }
  }


  std::optional<Tensor<2, 3>>
  NodalUpdate::mass_at(const unsigned int node) const
  {
    const auto slot = terms.slot_at(node);
    if (!slot)
      return {};
    Tensor<2, 3> result = invert(inverse[*slot]);
    for (unsigned int d = 0; d < 3; ++d)
      if (masses[*slot][d] == 0.)
        result[d][d] = 0.;
    return result;
  }


  Tensor<1, 3>
  NodalUpdate::holding_force(const unsigned int  slot,
                             const Tensor<1, 3> &next) const
  {
    const Tensor<1, 3> &last = last_velocity[slot];
    return terms.added_mass[slot] * (next - last) / leap_frog.time_step +
           damping_at(terms, slot, mass_coefficient) *
             leap_frog.damped(last, next) +
           terms.springs[slot] * last_displacement[slot] - applied[slot];
  }


  void
  NodalUpdate::before_step(const State        &state,
                           const Tensor<1, 3> &base_acceleration)
  {
    base = base_acceleration;
    for (unsigned int slot = 0; slot < terms.nodes.size(); ++slot)
      {
        last_displacement[slot] =
          node_value(state.displacement, terms.nodes[slot]);
        last_velocity[slot] = node_value(state.velocity, terms.nodes[slot]);
      }
  }


  void
  NodalUpdate::correct(State &state, const NodalForces &forces)
  {
    const double time_step           = leap_frog.time_step,
                 lag                 = leap_frog.explicit_share();
    EnergyAccounts &accounts         = state.accounts;
    const bool      has_mass_damping = mass_coefficient != 0.,
               has_base              = base.norm_square() > 0.;
    for (unsigned int slot = 0; slot < terms.nodes.size(); ++slot)
      {
        const unsigned int  node     = terms.nodes[slot];
        const Tensor<1, 3> &last     = last_velocity[slot];
        const auto         &dashpots = terms.dashpots[slot];
        const auto         &water    = terms.added_mass[slot];
        applied[slot]                = forces.of_slot(slot);
        Tensor<1, 3> momentum        = -lag * (dashpots * last);
        if (has_water[slot])
          {
            // the added mass is driven by the motion of a rigid base
            applied[slot] -= water * base;
            momentum += (1. - lag * mass_coefficient) * (water * last);
          }
        momentum += time_step * (applied[slot] -
                                 terms.springs[slot] * last_displacement[slot]);
        const Tensor<1, 3> swept = node_value(state.velocity, node);
        for (unsigned int d = 0; d < 3; ++d)
          momentum[d] = masses[slot][d] == 0. ?
                          0. :
                          momentum[d] + masses[slot][d] * swept[d];
        const Tensor<1, 3> next   = inverse[slot] * momentum;
        const Tensor<1, 3> mean   = 0.5 * (next + last),
                           damped = leap_frog.damped(last, next);
        accounts.work_of_forces += time_step * (applied[slot] * mean);
        accounts.loss_in_dashpots += time_step * (mean * (dashpots * damped));
        for (unsigned int d = 0; d < 3; ++d)
          {
            const unsigned int entry            = 3 * node + d;
            state.velocity.local_element(entry) = next[d];
            state.displacement.local_element(entry) =
              last_displacement[slot][d] + time_step * next[d];
          }

        // the sweep has added this work for the motion without nodal terms
        if (has_base)
          for (unsigned int d = 0; d < 3; ++d)
            accounts.work_of_base -= 0.5 * time_step *
                                     mass.driven().local_element(3 * node + d) *
                                     base[d] * (next[d] - swept[d]);
        if (has_mass_damping)
          {
            if (has_water[slot])
              accounts.loss_by_mass +=
                time_step * mass_coefficient * (mean * (water * damped));
            const Tensor<1, 3> damped_swept = leap_frog.damped(last, swept);
            for (unsigned int d = 0; d < 3; ++d)
              accounts.loss_by_mass +=
                time_step * mass_coefficient *
                mass.mass.local_element(3 * node + d) *
                (mean[d] * damped[d] -
                 0.5 * (swept[d] + last[d]) * damped_swept[d]);
          }
      }
  }


  void
  NodalUpdate::account_for(const unsigned int  slot,
                           const Tensor<1, 3> &velocity,
                           const Tensor<1, 3> &change,
                           EnergyAccounts     &accounts) const
  {
    const Tensor<1, 3> &last     = last_velocity[slot];
    const auto         &dashpots = terms.dashpots[slot];
    const Tensor<1, 3>  mean     = 0.5 * (velocity + last),
                       was = mean - 0.5 * change, predicted = velocity - change;
    accounts.work_of_forces +=
      leap_frog.time_step * (applied[slot] * (mean - was));
    accounts.loss_in_dashpots +=
      leap_frog.time_step *
      (mean * (dashpots * leap_frog.damped(last, velocity)) -
       was * (dashpots * leap_frog.damped(last, predicted)));
    const auto &water = terms.added_mass[slot];
    accounts.loss_by_mass +=
      leap_frog.time_step * mass_coefficient *
      (mean * (water * leap_frog.damped(last, velocity)) -
       was * (water * leap_frog.damped(last, predicted)));
  }
} // namespace Voussoir
