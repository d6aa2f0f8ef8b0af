#include <voussoir/base/mpi.h>
#include <voussoir/output/energy.h>

namespace Voussoir
{
  using namespace dealii;

  EnergyBalance::EnergyBalance(const EquationOfMotion &equation,
                               const double            time_step)
    : equation(equation)
    , time_step(time_step)
    , moved(equation.discretization.create_vector())
    , moved_before(moved)
  {
    // what round-off makes of the static energy is no motion
    const InitialState &initial_state = equation.initial;
    if (initial_state.force.size() > 0)
      round_off =
        1e-12 * std::abs(initial_state.displacement * initial_state.force);
  }


  void
  EnergyBalance::open(const std::string &folder,
                      const double       start_time,
                      const bool         restarted)
  {
    table.open(equation.discretization.grid.communicator(),
               folder + "/energy.csv",
               {"kinetic [J]",
                "strain [J]",
                "memory [J]",
                "damping [J]",
                "boundary [J]",
                "material [J]",
                "input [J]",
                "constraints [J]",
                "unaccounted [J]"},
               time_step,
               start_time,
               restarted);
  }


  EnergyTerms
  EnergyBalance::terms_at(const State &state)
  {
    const InitialState &initial_state = equation.initial;
    moved                             = state.displacement;
    if (initial_state.displacement.size() > 0)
      moved -= initial_state.displacement;

    // local sums first, then one reduction
    double kinetic = 0.;
    for (unsigned int i = 0; i < state.velocity.locally_owned_size(); ++i)
      {
        const double v = state.velocity.local_element(i);
        kinetic += 0.5 * equation.mass.mass.local_element(i) * v * v;
        moved_before.local_element(i) = moved.local_element(i) - time_step * v;
      }
    kinetic += equation.terms.kinetic_energy(state.velocity);
    const EnergyAccounts     &accounts = state.accounts;
    const std::vector<double> sums     = sum_over_ranks(
      std::vector<double>{kinetic,
                              equation.terms.spring_energy(moved, moved_before),
                              accounts.loss_in_dashpots,
                              accounts.work_of_forces + accounts.work_of_base,
                              accounts.work_of_projections,
                              accounts.loss_by_mass,
                              state.material_memory.dissipated()},
      equation.discretization.grid.communicator());

    EnergyTerms terms;
    terms.kinetic = sums[0];
    terms.strain  = equation.internal_force.stored_energy(state.displacement,
                                                         state.material_memory,
                                                         initial_state,
                                                         moved,
                                                         moved_before) +
                   sums[1];
    terms.boundary    = sums[2];
    terms.input       = sums[3];
    terms.constraints = sums[4];
    terms.damping     = sums[5];
    terms.material    = sums[6];
    // of the work of contact, what its static forces do on the way
    if (initial_state.contact_force.size() > 0)
      terms.constraints -= 0.5 * (initial_state.contact_force * moved +
                                  initial_state.contact_force * moved_before);
    return terms;
  }


  double
  EnergyBalance::damping_of_cells(const State &state, EnergyTerms &terms) const
  {
    // branch i is a spring D_i s K with a dashpot: stored w^T K w / (2 D_i /
    // s), lost w^T K w / (D_i tau_i) per time
    const Damping &damping   = equation.damping;
    double         loss_rate = 0.;
    for (unsigned int i = 0; i < state.memory.size(); ++i)
      if (damping.coefficients[i] > 0.)
        {
          const double work =
            equation.internal_force.damping_work(state.memory[i],
                                                 state.memory[i],
                                                 state.material_memory);
          terms.memory += 0.5 * work / damping.coefficients[i];
          loss_rate +=
            work / (damping.coefficients[i] * damping.relaxation_times[i]);
        }
    if (damping.stiffness_coefficient > 0.)
      loss_rate += damping.stiffness_coefficient *
                   equation.internal_force.damping_work(state.velocity,
                                                        state.velocity,
                                                        state.material_memory);
    return loss_rate;
  }


  const EnergyTerms &
  EnergyBalance::evaluate(const State &state)
  {
    terms_now              = terms_at(state);
    const double loss_rate = damping_of_cells(state, terms_now);
    if (first)
      {
        initial = terms_now.stored();
        first   = false;
      }
    else
      loss_of_cells +=
        0.5 * (loss_rate + last_loss_rate) * (state.time - last_time);
    terms_now.damping += loss_of_cells;
    last_loss_rate = loss_rate;
    last_time      = state.time;

    largest_turnover =
      std::max({largest_turnover,
                std::abs(terms_now.input + terms_now.constraints),
                terms_now.boundary,
                initial,
                round_off});
    if (largest_turnover > 0.)
      largest_error =
        std::max(largest_error,
                 std::abs(terms_now.error(initial)) / largest_turnover);
    table.write(state.time,
                {terms_now.kinetic,
                 terms_now.strain,
                 terms_now.memory,
                 terms_now.damping,
                 terms_now.boundary,
                 terms_now.material,
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


  double
  EnergyBalance::relative_error() const
  {
    return largest_turnover > 0. ?
             std::abs(terms_now.error(initial)) / largest_turnover :
             0.;
  }


  std::string
  EnergyBalance::alarm() const
  {
    if (!std::isfinite(terms_now.stored()))
      return "the motion is no longer finite (NaN or infinite)";
    if (terms_now.stored() > 100. * (largest_turnover + 1e-9))
      return "the stored energy has grown to a hundred times all energy that "
             "came in";
    return "";
  }


  nlohmann::json
  EnergyBalance::summary() const
  {
    return {{"kinetic [J]", terms_now.kinetic},
            {"strain [J]", terms_now.strain},
            {"damping memory [J]", terms_now.memory},
            {"lost in damping [J]", terms_now.damping},
            {"gone through the boundary [J]", terms_now.boundary},
            {"lost to cracks and plastic flow [J]", terms_now.material},
            {"input [J]", terms_now.input},
            {"work of constraints [J]", terms_now.constraints},
            {"initial [J]", initial},
            {"unaccounted, share of the input", relative_error()},
            {"largest unaccounted share", largest_error}};
  }


  nlohmann::json
  EnergyBalance::save() const
  {
    return {{"loss of cells", loss_of_cells},
            {"initial", initial},
            {"largest_turnover", largest_turnover},
            {"largest_error", largest_error},
            {"last_time", last_time},
            {"last_loss_rate", last_loss_rate}};
  }


  void
  EnergyBalance::load(const nlohmann::json &saved)
  {
    loss_of_cells    = saved.at("loss of cells");
    initial          = saved.at("initial");
    largest_turnover = saved.at("largest_turnover");
    largest_error    = saved.at("largest_error");
    last_time        = saved.at("last_time");
    last_loss_rate   = saved.at("last_loss_rate");
    first            = false;
  }
} // namespace Voussoir
