#include <voussoir/base/json_entries.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/sum.h>
#include <voussoir/fem/nodal_values.h>
#include <voussoir/output/energy.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Steps from one evaluation of the balance, which takes as long as two or
    // three steps, to the next: 100 at most, one in models small enough for
    // that cost ...
    unsigned int
    most_steps_between(const types::global_dof_index n_unknowns)
    {
      return std::min<types::global_dof_index>(100, 1 + n_unknowns / 1000);
    }

    // ... and no more than the trapezoidal rule allows: the loss of the cells
    // may change by this share of itself, or this share of the energy that came
    // in.
    constexpr double largest_change = 0.06, share_that_counts = 0.01;
  } // namespace


  template <typename Entry>
  void
  for_each_entry(EnergySummary &part, const Entry &entry)
  {
    entry("kinetic [J]", part.terms.kinetic);
    entry("strain [J]", part.terms.strain);
    entry("damping memory [J]", part.terms.memory);
    entry("lost in damping [J]", part.terms.damping);
    entry("radiated through the boundary [J]", part.terms.boundary);
    entry("lost to cracks and plastic flow [J]", part.terms.material);
    entry("lost by cracks that closed [J]", part.terms.closing);
    entry("input [J]", part.terms.input);
    entry("work of constraints [J]", part.terms.constraints);
    entry("initial [J]", part.initial);
    entry("energy-balance error [J]", part.error);
    entry("energy-balance error, share of the input", part.error_of_input);
    entry("largest energy-balance error", part.largest_error);
    entry("energy-balance error, share of the losses", part.error_of_losses);
  }


  void
  to_json(nlohmann::json &json, const EnergySummary &summary)
  {
    write_entries(json, summary);
  }


  void
  from_json(const nlohmann::json &json, EnergySummary &summary)
  {
    read_entries(json, summary);
  }


  EnergyBalance::EnergyBalance(const EquationOfMotion &equation,
                               const double            time_step,
                               const double            interval)
    : equation(equation)
    , time_step(time_step)
    , viscous(equation.damping.stiffness_coefficient > 0. ||
              equation.damping.mesh_viscosity > 0.)
    , most_steps(most_steps_between(equation.discretization.owned_dofs.size()))
    , lines(interval > 0. ? interval : 50. * time_step, time_step)
    , moved(equation.discretization.create_vector())
  {
    const InitialState &initial_state = equation.initial;
    if (initial_state.force.size() > 0)
      static_work = std::abs(product(initial_state.displacement,
                                     initial_state.force,
                                     equation.discretization.reproducible));
    if (viscous)
      velocity_before = moved;
  }


  void
  EnergyBalance::open(const std::string &folder,
                      const double       start_time,
                      const bool         restarted,
                      Log               &log)
  {
    table.open(log,
               folder + "/energy.csv",
               {"kinetic [J]",
                "strain [J]",
                "memory [J]",
                "damping [J]",
                "boundary [J]",
                "material [J]",
                "closing cracks [J]",
                "input [J]",
                "constraints [J]",
                "energy-balance error [J]"},
               time_step,
               start_time,
               restarted);
  }


  bool
  EnergyBalance::is_due(const unsigned long long step) const
  {
    return step >= due_step || lines.due(step);
  }


  void
  EnergyBalance::before_step(const State &state)
  {
    if (viscous)
      velocity_before = state.velocity;
    kept_step = state.step + 1;
  }


  double
  EnergyBalance::loss_in_cells(const unsigned long long step,
                               const double             next,
                               const double             last)
  {
    // losses of the steps in between; the weights of the ends make a single
    // step exact
    const unsigned int n = first ? 0 : step - loss_step;
    const double       loss =
      n == 0 ? known_loss :
                     known_loss + 0.5 * ((n + 1.) * next_loss + (n - 1.) * next) +
                 0.5 * ((n - 1.) * last_loss + (n + 1.) * last);
    // evaluations outside the schedule do not change the schedule
    if (!first && (n == 0 || !is_due(step)))
      return loss;

    const double change  = n * (std::abs(next - next_loss) +
                               std::abs(last - last_loss)),
                 allowed = largest_change *
                           std::max(known_loss, share_that_counts * came_in);
    if (n > 1 && change > allowed)
      steps_between = n / 2;
    else if (n > 0 && 4. * change < allowed) // not before something moves
      steps_between = std::min(most_steps, std::max(steps_between, 2 * n));
    known_loss = loss;
    next_loss  = next;
    last_loss  = last;
    loss_step  = step;
    due_step   = step + steps_between;
    return loss;
  }


  void
  EnergyBalance::sum_up(State &state)
  {
    const InitialState &initial_state = equation.initial;
    moved                             = state.displacement;
    if (initial_state.displacement.size() > 0)
      moved -= initial_state.displacement;

    const bool is_exact = equation.discretization.reproducible;
    Sum        kinetic(is_exact);
    for (unsigned int i = 0; i < state.velocity.locally_owned_size(); ++i)
      {
        const double v = state.velocity.local_element(i);
        kinetic += 0.5 * equation.mass.mass.local_element(i) * v * v;
      }
    kinetic += equation.terms.kinetic_energy(state.velocity, is_exact);
    const bool          knows_velocity = viscous && kept_step == state.step;
    const ElasticEnergy elastic =
      equation.internal_force.elastic_energy({moved,
                                              state.velocity,
                                              knows_velocity ? velocity_before :
                                                               state.velocity,
                                              state.memory,
                                              equation.damping,
                                              time_step},
                                             state.material_memory);
    const InelasticEnergy inelastic =
      equation.internal_force.inelastic_energy(state.displacement,
                                               state.material_memory,
                                               initial_state,
                                               equation.damping);

    // local sums first, then one reduction
    const EnergyAccounts &accounts = state.accounts;
    const PointLosses     lost     = state.material_memory.losses();
    Sum                   strain   = elastic.strain;
    strain += inelastic.stored;
    strain +=
      equation.terms.spring_energy(moved, state.velocity, time_step, is_exact);
    Sum damping = accounts.loss_by_mass;
    damping += lost.damping;
    damping -= inelastic.damping;
    Sum input = accounts.work_of_forces;
    input += accounts.work_of_base;
    std::vector<Sum>          of_rank{kinetic,
                             strain,
                             elastic.memory,
                             damping,
                             elastic.next_loss,
                             elastic.last_loss,
                             accounts.loss_in_dashpots,
                             lost.material,
                             lost.closing,
                             input,
                             accounts.work_of_projections};
    const std::vector<double> sums =
      sum_over_ranks(of_rank, equation.discretization.grid.communicator());

    EnergyTerms &terms = terms_now;
    terms.kinetic      = sums[0];
    terms.strain       = sums[1];
    terms.memory       = sums[2];
    terms.damping      = sums[3] + loss_in_cells(state.step, sums[4], sums[5]);
    terms.boundary     = sums[6];
    terms.material     = sums[7];
    terms.closing      = sums[8];
    terms.input        = sums[9];
    terms.constraints  = sums[10];
    // subtracts the work of the static contact forces
    if (initial_state.contact_force.size() > 0)
      {
        moved.add(-0.5 * time_step, state.velocity); // in the half step
        terms.constraints -=
          product(initial_state.contact_force, moved, is_exact);
      }
  }


  double
  EnergyBalance::least_scale(const unsigned long long step) const
  {
    // the energy of waves that pass through the rock is a thousand times the
    // energy that stays; the balance cannot be more accurate than the round-off
    // of the former and of the static energy
    const bool   is_exact = equation.discretization.reproducible;
    const double net      = terms_now.input - terms_now.boundary;
    const double round_off =
      equation.discretization.single_precision ? 5e-4 : 1e-12;
    // this round-off grows with each step, as does that of the terms of exact
    // sums
    const double of_step =
      std::numeric_limits<double>::epsilon() * static_work +
      (is_exact ? 0x1p-62 * equation.discretization.owned_dofs.size() : 0.);
    // cracks release energy of the static state, too
    return std::max({std::abs(net),
                     std::abs(net + terms_now.constraints),
                     std::abs(terms_now.material),
                     1e-6 * terms_now.boundary,
                     initial,
                     round_off * static_work,
                     100. * of_step * (step + 1.)});
  }


  const EnergyTerms &
  EnergyBalance::evaluate(State &state, const bool end)
  {
    sum_up(state);
    if (first)
      initial = terms_now.stored() + terms_now.lost() - terms_now.input -
                terms_now.constraints;
    first         = false;
    most_damping  = std::max(most_damping, terms_now.damping);
    came_in       = std::max(came_in, least_scale(state.step));
    largest_error = std::max(largest_error, relative_error());
    if (!lines.due(state.step) && !end)
      return terms_now;
    table.write(state.time,
                {terms_now.kinetic,
                 terms_now.strain,
                 terms_now.memory,
                 terms_now.damping,
                 terms_now.boundary,
                 terms_now.material,
                 terms_now.closing,
                 terms_now.input,
                 terms_now.constraints,
                 terms_now.error(initial)});
    table.flush();
    return terms_now;
  }


  const EnergyTerms &
  EnergyBalance::latest() const
  {
    return terms_now;
  }


  namespace
  {
    /** Decrease of the losses by damping, which must not decrease [J]. */
    double
    given_back(const EnergyTerms &terms, const double most_damping)
    {
      return std::max(most_damping - terms.damping, 0.);
    }


    /** Energy gained by cracks that closed [J]. */
    double
    made_by_closing(const EnergyTerms &terms)
    {
      return std::max(-terms.closing, 0.);
    }
  } // namespace


  double
  EnergyBalance::made() const
  {
    return std::abs(terms_now.error(initial)) +
           given_back(terms_now, most_damping) + made_by_closing(terms_now);
  }


  double
  EnergyBalance::relative_error() const
  {
    return came_in > 0. ? made() / came_in : 0.;
  }


  double
  EnergyBalance::error_of_losses() const
  {
    const double losses = terms_now.damping + terms_now.material +
                          std::max(terms_now.closing, 0.) +
                          std::max(-terms_now.constraints, 0.);
    return losses > 0.1 * came_in ? made() / losses : 0.;
  }


  std::string
  EnergyBalance::alarm(const double limit) const
  {
    if (!std::isfinite(terms_now.stored()) || !std::isfinite(made()))
      return equation.discretization.reproducible ?
               "the motion is no longer finite (NaN or infinite), or a cell is "
               "strained by more than a sixteenth, where \"Sums = "
               "reproducible\" does not hold" :
               "the motion is no longer finite (NaN or infinite)";
    // with an unstable step the sum is constant: strain energy decreases as
    // kinetic energy grows, which is also the case, within bounds, when parts
    // fall
    if (std::max(terms_now.kinetic, terms_now.stored()) >
        100. * (came_in + static_work + 1e-9))
      return "the motion has grown to a hundred times the energy input";
    if (relative_error() > limit)
      {
        std::ostringstream text;
        text << std::setprecision(3) << "the energy-balance error is "
             << 100. * relative_error() << " % of the energy input ("
             << terms_now.error(initial) << " J residual, "
             << given_back(terms_now, most_damping)
             << " J of negative loss by damping, " << made_by_closing(terms_now)
             << " J gained by cracks that close)";
        return text.str();
      }
    return "";
  }


  EnergySummary
  EnergyBalance::summary() const
  {
    return {terms_now,
            initial,
            terms_now.error(initial),
            relative_error(),
            largest_error,
            error_of_losses()};
  }


  nlohmann::json
  EnergyBalance::save() const
  {
    return {{"initial", initial},
            {"loss in cells", known_loss},
            {"loss of the next step", next_loss},
            {"loss of the last step", last_loss},
            {"step", loss_step},
            {"steps between", steps_between},
            {"due", due_step},
            {"terms",
             {terms_now.kinetic,
              terms_now.strain,
              terms_now.memory,
              terms_now.damping,
              terms_now.boundary,
              terms_now.material,
              terms_now.closing,
              terms_now.input,
              terms_now.constraints}},
            {"most damping", most_damping},
            {"came in", came_in},
            {"largest error", largest_error}};
  }


  void
  EnergyBalance::load(const nlohmann::json &saved)
  {
    initial                         = saved.at("initial");
    known_loss                      = saved.at("loss in cells");
    next_loss                       = saved.at("loss of the next step");
    last_loss                       = saved.at("loss of the last step");
    loss_step                       = saved.at("step");
    steps_between                   = saved.at("steps between");
    due_step                        = saved.at("due");
    const std::vector<double> terms = saved.at("terms");
    terms_now                       = {terms.at(0),
                                       terms.at(1),
                                       terms.at(2),
                                       terms.at(3),
                                       terms.at(4),
                                       terms.at(5),
                                       terms.at(6),
                                       terms.at(7),
                                       terms.at(8)};
    most_damping                    = saved.at("most damping");
    came_in                         = saved.at("came in");
    largest_error                   = saved.at("largest error");
    first                           = false;
  }
} // namespace Voussoir
