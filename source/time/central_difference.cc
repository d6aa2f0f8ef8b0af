#include <voussoir/fem/nodal_values.h>
#include <voussoir/time/central_difference.h>

#include <set>

namespace Voussoir
{
  using namespace dealii;

  CentralDifference::CentralDifference(
    const Discretization                            &discretization,
    const InternalForce                             &internal_force,
    const LumpedMass                                &mass,
    const Damping                                   &damping,
    NodalTerms                                      &terms,
    const InitialState                              &initial,
    const std::vector<Projection *>                 &projections,
    const std::function<void(const double)>         &evaluate_loads,
    const std::function<void(const State &)>        &after_step,
    const std::function<Tensor<1, 3>(const double)> &base_acceleration,
    const bool                                       paper_scheme,
    const double                                     time_step)
    : time_step(time_step)
    , discretization(discretization)
    , internal_force(internal_force)
    , mass(mass)
    , terms(terms)
    , initial(initial)
    , projections(projections)
    , evaluate_loads(evaluate_loads)
    , after_step(after_step)
    , base_acceleration(base_acceleration)
    , n_branches(damping.n_branches())
    , mass_coefficient(damping.mass_coefficient)
    , stiffness_coefficient(damping.stiffness_coefficient)
    , central(!paper_scheme)
    , damped(n_branches > 0 || stiffness_coefficient != 0.)
    , uniform(internal_force.uniform_damping() || !damped)
    , uniform_factor(internal_force.damping_factor())
    , force(discretization.create_vector())
    , effective(force)
  {
    if (!uniform)
      memory = force;
    // exact update of a branch over a step of constant velocity
    for (unsigned int i = 0; i < n_branches; ++i)
      {
        const double tau = damping.relaxation_times[i];
        decay.push_back(std::exp(-time_step / tau));
        gain.push_back(damping.coefficients[i] * (1. - decay[i]) * tau);
      }
    terms.prepare(mass, mass_coefficient, time_step, central);

    std::set<unsigned int> projected, prescribed;
    for (const Projection *projection : projections)
      {
        const auto &nodes = projection->nodes();
        projected.insert(nodes.begin(), nodes.end());
        if (projection->prescribes())
          prescribed.insert(nodes.begin(), nodes.end());
      }
    projected_nodes.assign(projected.begin(), projected.end());
    for (const unsigned int node : projected_nodes)
      projected_slots.push_back(terms.slot_at(node));
    predicted_velocity.resize(projected_nodes.size());
    last_velocity.resize(projected_nodes.size());
    const auto inverse_mass = [&](const unsigned int node) {
      Tensor<2, 3> result;
      if (prescribed.count(node) > 0)
        return result;
      if (const auto with_terms = terms.inverse_at(node))
        return *with_terms;
      for (unsigned int d = 0; d < 3; ++d)
        result[d][d] = mass.inverse.local_element(3 * node + d) /
                       (central ? 1. + 0.5 * time_step * mass_coefficient : 1.);
      return result;
    };
    for (Projection *projection : projections)
      projection->prepare_step(inverse_mass, time_step);
  }


  State
  CentralDifference::state_at_rest() const
  {
    State state;
    state.velocity = discretization.create_vector();
    state.memory.assign(n_branches, state.velocity);
    state.displacement =
      initial.displacement.size() > 0 ? initial.displacement : state.velocity;
    state.material_memory = initial.material_memory;
    return state;
  }


  void
  CentralDifference::step(State &state)
  {
    const Tensor<1, 3> base =
      base_acceleration ? base_acceleration(state.time) : Tensor<1, 3>();
    evaluate_loads(state.time);
    terms.before_step(state.displacement, state.velocity, base);
    for (unsigned int i = 0; i < projected_nodes.size(); ++i)
      last_velocity[i] = node_value(state.velocity, projected_nodes[i]);

    // f(u_n) with the damping memory, and the motion it alone would cause
    internal_force.sweep(
      force,
      effective,
      uniform ? nullptr : &memory,
      uniform && damped ? state.displacement : effective,
      state.material_memory,
      time_step,
      [&](const unsigned int begin, const unsigned int end) {
        update_memory(state, begin, end);
      },
      [&](const unsigned int begin, const unsigned int end) {
        update_motion(state, base, begin, end);
      });

    terms.correct(state.displacement, state.velocity);
    state.time = ++state.step * time_step;
    project(state, base);
    if (after_step)
      after_step(state);
  }


  void
  CentralDifference::project(State &state, const Tensor<1, 3> &base)
  {
    for (unsigned int i = 0; i < projected_nodes.size(); ++i)
      predicted_velocity[i] = node_value(state.velocity, projected_nodes[i]);
    for (Projection *projection : projections)
      work_of_projections += projection->project(state, time_step).work;

    // loads and damping did their work on the predicted motion
    for (unsigned int i = 0; i < projected_nodes.size(); ++i)
      {
        const unsigned int node     = projected_nodes[i];
        const Tensor<1, 3> velocity = node_value(state.velocity, node);
        const Tensor<1, 3> change   = velocity - predicted_velocity[i];
        if (change.norm_square() == 0.)
          continue;
        if (projected_slots[i])
          terms.account_for(*projected_slots[i], velocity, change);
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double last = last_velocity[i][d],
                         mean = 0.5 * (velocity[d] + last),
                         was  = mean - 0.5 * change[d];
            work_of_base -= time_step *
                            mass.driven.local_element(3 * node + d) * base[d] *
                            (mean - was);
            loss_by_mass +=
              time_step * mass_coefficient *
              mass.mass.local_element(3 * node + d) *
              (mean * (central ? mean : last) - was * (central ? was : last));
          }
      }
  }


  void
  CentralDifference::update_memory(State             &state,
                                   const unsigned int begin,
                                   const unsigned int end)
  {
    const double *v = state.velocity.begin();
    const double *u = state.displacement.begin();
    double       *f = force.begin();
    double       *e = effective.begin();
    double       *w = uniform ? e : memory.begin();

    // sum of the branches, or beta v
    const double factor = uniform ? uniform_factor : 1.;
    switch (n_branches)
      {
        case 0:
#pragma GCC ivdep
          for (unsigned int i = begin; i < end; ++i)
            w[i] = factor * stiffness_coefficient * v[i];
          break;
        case 3: // the default, in one pass
          {
            double      *w0 = state.memory[0].begin();
            double      *w1 = state.memory[1].begin();
            double      *w2 = state.memory[2].begin();
            const double a0 = decay[0], a1 = decay[1], a2 = decay[2];
            const double b0 = gain[0], b1 = gain[1], b2 = gain[2];
#pragma GCC ivdep
            for (unsigned int i = begin; i < end; ++i)
              {
                w0[i] = a0 * w0[i] + b0 * v[i];
                w1[i] = a1 * w1[i] + b1 * v[i];
                w2[i] = a2 * w2[i] + b2 * v[i];
                w[i]  = factor * (w0[i] + w1[i] + w2[i]);
              }
            break;
          }
        default:
          std::fill(w + begin, w + end, 0.);
          for (unsigned int k = 0; k < n_branches; ++k)
            {
              double      *wk = state.memory[k].begin();
              const double ak = decay[k], bk = gain[k];
#pragma GCC ivdep
              for (unsigned int i = begin; i < end; ++i)
                {
                  wk[i] = ak * wk[i] + bk * v[i];
                  w[i] += factor * wk[i];
                }
            }
      }

#pragma GCC ivdep
    for (unsigned int i = begin; i < end; ++i)
      e[i] = uniform ? e[i] + u[i] : u[i];

    // the internal force is added to minus the steady one
    if (initial.force.size() > 0)
      {
        const double *steady = initial.force.begin();
#pragma GCC ivdep
        for (unsigned int i = begin; i < end; ++i)
          f[i] = -steady[i];
      }
    else
      std::fill(f + begin, f + end, 0.);
  }


  void
  CentralDifference::update_motion(State              &state,
                                   const Tensor<1, 3> &base,
                                   const unsigned int  begin,
                                   const unsigned int  end)
  {
    double       *v       = state.velocity.begin();
    double       *u       = state.displacement.begin();
    const double *f       = force.begin();
    const double *inverse = mass.inverse.begin();

    // alpha M v centrally, or with v-
    const double keep = central ? (1. - 0.5 * time_step * mass_coefficient) /
                                    (1. + 0.5 * time_step * mass_coefficient) :
                                  1. - time_step * mass_coefficient;
    const double push =
      central ? time_step / (1. + 0.5 * time_step * mass_coefficient) :
                time_step;

    if (!base_acceleration && mass_coefficient == 0.)
      {
#pragma GCC ivdep
        for (unsigned int i = begin; i < end; ++i)
          {
            v[i] -= time_step * inverse[i] * f[i];
            u[i] += time_step * v[i];
          }
      }
    else
      {
        const double *diagonal = mass.mass.begin();
        const double *driven   = mass.driven.begin();
        for (unsigned int i = begin; i < end; ++i)
          {
            const double inertia = driven[i] * base[i % 3];
            const double before  = v[i];
            v[i] = keep * v[i] - push * inverse[i] * (f[i] + inertia);
            u[i] += time_step * v[i];

            const double mean = 0.5 * (before + v[i]);
            work_of_base -= time_step * inertia * mean;
            loss_by_mass += time_step * mass_coefficient * diagonal[i] * mean *
                            (central ? mean : before);
          }
      }
  }
} // namespace Voussoir
