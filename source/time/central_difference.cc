#include <voussoir/fem/nodal_values.h>
#include <voussoir/time/central_difference.h>

#include <algorithm>
#include <limits>
#include <set>

namespace Voussoir
{
  using namespace dealii;

  CentralDifference::CentralDifference(const EquationOfMotion &equation,
                                       const LeapFrog         &leap_frog)
    : time_step(leap_frog.time_step)
    , equation(equation)
    , leap_frog(leap_frog)
    , maxwell(equation.damping, time_step)
    , nodal_update(equation.terms,
                   equation.mass,
                   equation.damping.mass_coefficient,
                   leap_frog)
    , mass_coefficient(equation.damping.mass_coefficient)
    , stiffness_coefficient(equation.damping.stiffness_coefficient)
    , point_step{time_step,
                 equation.closing_viscosity,
                 equation.damping.branch_stiffness(),
                 maxwell.decay.empty() ?
                   1. :
                   std::pow(*std::max_element(maxwell.decay.begin(),
                                              maxwell.decay.end()),
                            2),
                 maxwell.decay.empty() ? nullptr : &maxwell}
    , uniform(
        equation.internal_force.uniform_damping() ||
        (equation.damping.n_branches() == 0 && stiffness_coefficient == 0.))
    , forces(equation.terms)
    , force(equation.discretization.create_vector())
    , effective(force)
    , memory(uniform ? Vector() : force)
  {
    initialize_projections();
  }


  Tensor<2, 3>
  CentralDifference::mass_at(const unsigned int node) const
  {
    if (const auto with_terms = nodal_update.mass_at(node))
      return *with_terms;
    Tensor<2, 3> result;
    for (unsigned int d = 0; d < 3; ++d)
      result[d][d] = (1. + leap_frog.implicit_share() * mass_coefficient) *
                     equation.mass.mass.local_element(3 * node + d);
    return result;
  }


  void
  CentralDifference::initialize_projections()
  {
    using Components = std::array<bool, 3>;
    std::set<unsigned int>             projected;
    std::map<unsigned int, Components> prescribed;
    for (const Projection *projection : equation.projections)
      {
        const auto &nodes = projection->nodes();
        projected.insert(nodes.begin(), nodes.end());
        for (const unsigned int node : nodes)
          for (unsigned int d = 0; d < 3; ++d)
            if (projection->prescribed_components()[d])
              prescribed[node][d] = true;
      }
    projected_nodes.assign(projected.begin(), projected.end());
    for (const unsigned int node : projected_nodes)
      projected_slots.push_back(equation.terms.slot_at(node));
    last_velocity.resize(projected_nodes.size());
    predicted_velocity.resize(projected_nodes.size());

    for (Projection *projection : equation.projections)
      projection->prepare_step(
        [&](const unsigned int node) {
          const Tensor<2, 3> mass       = mass_at(node);
          const Components   own        = projection->prescribed_components();
          const auto         all        = prescribed.find(node);
          const auto         can_change = [&](const unsigned int d) {
            return mass[d][d] > 0. &&
                   (all == prescribed.end() || !all->second[d] || own[d]);
          };
          Tensor<2, 3> result;
          for (unsigned int d = 0; d < 3; ++d)
            for (unsigned int e = 0; e < 3; ++e)
              result[d][e] =
                can_change(d) && can_change(e) ? mass[d][e] : double(d == e);
          result = invert(result);
          for (unsigned int d = 0; d < 3; ++d)
            if (!can_change(d))
              result[d][d] = 0.;
          return result;
        },
        time_step);
  }


  Tensor<1, 3>
  CentralDifference::support_force(const State       &state,
                                   const unsigned int node) const
  {
    Tensor<1, 3>       result;
    const Tensor<1, 3> velocity = node_value(state.velocity, node),
                       mass     = node_value(equation.mass.mass, node);
    const auto         slot     = equation.terms.slot_at(node);
    const Tensor<1, 3> holding =
      slot ? nodal_update.holding_force(*slot, velocity) : Tensor<1, 3>();
    for (unsigned int d = 0; d < 3; ++d)
      if (mass[d] == 0.)
        result[d] = force.local_element(3 * node + d) + holding[d];

    const auto projected =
      std::lower_bound(projected_nodes.begin(), projected_nodes.end(), node);
    if (projected != projected_nodes.end() && *projected == node)
      result +=
        mass_at(node) *
        (velocity - predicted_velocity[projected - projected_nodes.begin()]) /
        time_step;
    return result;
  }


  State
  CentralDifference::initial_state() const
  {
    State state;
    state.accounts = EnergyAccounts(equation.discretization.reproducible);
    state.material_memory = equation.initial.material_memory;
    state.velocity        = equation.discretization.create_vector();
    state.memory.assign(maxwell.decay.size(), state.velocity);
    state.displacement = equation.initial.displacement.size() > 0 ?
                           equation.initial.displacement :
                           state.velocity;
    return state;
  }


  void
  CentralDifference::step(State &state)
  {
    const Tensor<1, 3> base = equation.base != nullptr ?
                                equation.base->acceleration(state.time) :
                                Tensor<1, 3>();
    // F_n
    forces.reset();
    for (NodalLoad *load : equation.loads)
      load->add_forces(state.time, forces);

    nodal_update.before_step(state, base);
    for (unsigned int i = 0; i < projected_nodes.size(); ++i)
      last_velocity[i] = node_value(state.velocity, projected_nodes[i]);

    // one sweep: w_n of damping, f(u_n + s w_n) - F_0, and
    // v+ = v- - dt M^-1 (f - F_0), u_(n+1) = u_n + dt v+
    const std::optional<MotionBound> bound = bound_of_motion(state);
    const bool is_reproducible             = equation.internal_force.sweep(
      force,
      {state.displacement,
                   effective,
       uniform ? SweepInput::Damping::common : SweepInput::Damping::by_material,
                   &memory,
                   point_step,
       bound ? &*bound : nullptr,
                   equation.discretization.single_precision},
      state.material_memory,
      [&](const unsigned int begin, const unsigned int end) {
        update_memory(state, begin, end);
      },
      [&](const unsigned int begin, const unsigned int end) {
        update_motion(state, base, begin, end);
      },
      &time_of_cells);
    if (!is_reproducible) // the next line of the energy balance ends the run
      state.velocity = std::numeric_limits<double>::quiet_NaN();

    // (M + M_a + dt/2 C) v+ = ... + dt (F_n - K_b u_n) at nodes with these
    // terms
    nodal_update.correct(state, forces);
    state.time = ++state.step * time_step;

    // contact: u_(n+1) += dt^2 M^-1 R^T p
    project(state, base);

    for (NodalLoad *load : equation.loads)
      load->end_step(state);
    if (equation.crack_tips != nullptr)
      equation.crack_tips->update(state.step, state.material_memory);
    if (equation.crack_planes != nullptr)
      equation.crack_planes->update(time_step, state);
  }


  double
  CentralDifference::seconds_of_cells() const
  {
    return time_of_cells;
  }


  std::optional<MotionBound>
  CentralDifference::bound_of_motion(const State &state) const
  {
    // the force begins with that of the static state, whatever the motion
    if (!equation.discretization.reproducible ||
        equation.initial.force.size() > 0)
      return {};
    MotionBound bound{{{&state.displacement, 1.}},
                      equation.mass.mass,
                      time_step};
    double      of_velocity =
      equation.damping.mesh_viscosity + stiffness_coefficient;
    for (unsigned int i = 0; i < state.memory.size(); ++i)
      {
        bound.parts.emplace_back(&state.memory[i], maxwell.decay[i]);
        of_velocity += maxwell.gain[i];
      }
    bound.parts.emplace_back(&state.velocity, of_velocity);
    return bound;
  }


  void
  CentralDifference::project(State &state, const Tensor<1, 3> &base)
  {
    for (unsigned int i = 0; i < projected_nodes.size(); ++i)
      predicted_velocity[i] = node_value(state.velocity, projected_nodes[i]);
    for (Projection *projection : equation.projections)
      state.accounts.work_of_projections +=
        projection->project(state, time_step).work;
    // loads and damping did their work on the predicted motion
    for (unsigned int i = 0; i < projected_nodes.size(); ++i)
      account_for_projection(i, base, state);
  }


  void
  CentralDifference::account_for_projection(const unsigned int  i,
                                            const Tensor<1, 3> &base,
                                            State              &state) const
  {
    const unsigned int node     = projected_nodes[i];
    const Tensor<1, 3> velocity = node_value(state.velocity, node);
    const Tensor<1, 3> change   = velocity - predicted_velocity[i];
    if (change.norm_square() == 0.)
      return;
    if (projected_slots[i])
      nodal_update.account_for(*projected_slots[i],
                               velocity,
                               change,
                               state.accounts);
    const LumpedMass &mass = equation.mass;
    for (unsigned int d = 0; d < 3; ++d)
      {
        const unsigned int entry = 3 * node + d;
        const double       last  = last_velocity[i][d],
                     mean        = 0.5 * (velocity[d] + last),
                     was         = mean - 0.5 * change[d];
        state.accounts.work_of_base -= time_step *
                                       mass.driven().local_element(entry) *
                                       base[d] * (mean - was);
        state.accounts.loss_by_mass +=
          time_step * mass_coefficient * mass.mass.local_element(entry) *
          (mean * leap_frog.damped(last, velocity[d]) -
           was * leap_frog.damped(last, velocity[d] - change[d]));
      }
  }


  namespace
  {
    /** Advances n Maxwell branches from number @p first on, and sets @p w to
     *  their sum times @p factor or adds it, in one pass over the vectors. */
    template <unsigned int n, bool adds = false>
    void
    advance_branches(std::vector<Vector> &branches,
                     const MaxwellStep   &maxwell,
                     const unsigned int   first,
                     const double         factor,
                     const double        *v,
                     double              *w,
                     const unsigned int   begin,
                     const unsigned int   end)
    {
      std::array<double *, n> of_branch;
      std::array<double, n>   a, b;
      for (unsigned int k = 0; k < n; ++k)
        {
          of_branch[k] = branches[first + k].begin();
          a[k]         = maxwell.decay[first + k];
          b[k]         = maxwell.gain[first + k];
        }
#pragma GCC ivdep
      for (unsigned int i = begin; i < end; ++i)
        {
          double sum = 0.;
          for (unsigned int k = 0; k < n; ++k)
            sum += of_branch[k][i] = a[k] * of_branch[k][i] + b[k] * v[i];
          w[i] = adds ? w[i] + factor * sum : factor * sum;
        }
    }
  } // namespace


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
    const double factor =
      uniform ? equation.internal_force.damping_factor() : 1.;
    auto      &branches   = state.memory;
    const auto n_branches = branches.size();
    switch (n_branches)
      {
        case 0:
#pragma GCC ivdep
          for (unsigned int i = begin; i < end; ++i)
            w[i] = factor * stiffness_coefficient * v[i];
          break;
        case 1:
          advance_branches<1>(branches, maxwell, 0, factor, v, w, begin, end);
          break;
        case 2:
          advance_branches<2>(branches, maxwell, 0, factor, v, w, begin, end);
          break;
        default:
          advance_branches<3>(branches, maxwell, 0, factor, v, w, begin, end);
          for (unsigned int k = 3; k < n_branches; ++k)
            advance_branches<1, true>(
              branches, maxwell, k, factor, v, w, begin, end);
      }

    const double viscosity = equation.damping.mesh_viscosity;
    if (uniform)
#pragma GCC ivdep
      for (unsigned int i = begin; i < end; ++i)
        e[i] += u[i] + viscosity * v[i];
    else
#pragma GCC ivdep
      for (unsigned int i = begin; i < end; ++i)
        e[i] = u[i] + viscosity * v[i];

    // the internal force is added to minus the steady one
    if (equation.initial.force.size() > 0)
      {
        const double *steady = equation.initial.force.begin();
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
    const double *inverse = equation.mass.inverse.begin();

    if (equation.base == nullptr && mass_coefficient == 0.)
      {
#pragma GCC ivdep
        for (unsigned int i = begin; i < end; ++i)
          {
            v[i] -= time_step * inverse[i] * f[i];
            u[i] += time_step * v[i];
          }
        return;
      }

    // M (v+ - v-)/dt + alpha M v = -(f - F_0) - M_driven a_base
    const double divisor = 1. + leap_frog.implicit_share() * mass_coefficient,
                 keep = (1. - leap_frog.explicit_share() * mass_coefficient) /
                        divisor,
                 push        = time_step / divisor;
    const double   *diagonal = equation.mass.mass.begin();
    const double   *driven   = equation.mass.driven().begin();
    EnergyAccounts &accounts = state.accounts;
    for (unsigned int i = begin; i < end; ++i)
      {
        const double inertia = driven[i] * base[i % 3];
        const double before  = v[i];
        v[i] = keep * v[i] - push * inverse[i] * (f[i] + inertia);
        u[i] += time_step * v[i];

        const double mean = 0.5 * (before + v[i]);
        accounts.work_of_base -= time_step * inertia * mean;
        accounts.loss_by_mass += time_step * mass_coefficient * diagonal[i] *
                                 mean * leap_frog.damped(before, v[i]);
      }
  }
} // namespace Voussoir
