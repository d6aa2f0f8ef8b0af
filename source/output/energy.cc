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
    if (initial_state.displacement.size() > 0)
      {
        force_at_rest = moved;
        equation.terms.add_to(force_at_rest, initial_state.displacement, 0.);
        force_at_rest *= -1.;
        if (initial_state.contact_force.size() > 0)
          force_at_rest += initial_state.contact_force;
      }
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
                "closing cracks [J]",
                "input [J]",
                "constraints [J]",
                "unaccounted [J]"},
               time_step,
               start_time,
               restarted);
  }


  double
  EnergyBalance::energy_of_branches(const State &state)
  {
    // branch i is a spring D_i s K: stored w_n^T K w_(n-1) / (2 D_i / s)
    const Damping    &damping = equation.damping;
    const MaxwellStep maxwell(damping, time_step);
    double            energy = 0.;
    for (unsigned int i = 0; i < state.memory.size(); ++i)
      if (damping.coefficients[i] > 0.)
        {
          Vector &next = moved_before; // has done its work
          next.equ(maxwell.decay[i], state.memory[i]);
          next.add(maxwell.gain[i], state.velocity);
          energy += 0.5 / damping.coefficients[i] *
                    equation.internal_force.elastic_work(state.memory[i],
                                                         next,
                                                         state.material_memory,
                                                         true);
        }
    return energy;
  }


  const EnergyTerms &
  EnergyBalance::evaluate(const State &state)
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
    const PointLosses         lost     = state.material_memory.losses();
    const std::vector<double> sums     = sum_over_ranks(
      std::vector<double>{kinetic,
                              equation.terms.spring_energy(moved, moved_before),
                              accounts.loss_in_dashpots,
                              accounts.work_of_forces + accounts.work_of_base,
                              accounts.work_of_projections,
                              accounts.loss_by_mass,
                              accounts.work_on_cells,
                              lost.material,
                              lost.closing},
      equation.discretization.grid.communicator());

    const double in_cells =
      equation.internal_force.stored_energy(state.displacement,
                                            state.material_memory,
                                            initial_state,
                                            moved,
                                            moved_before);
    EnergyTerms &terms = terms_now;
    terms.kinetic      = sums[0];
    terms.strain       = in_cells + sums[1];
    terms.boundary     = sums[2];
    terms.input        = sums[3];
    terms.constraints  = sums[4];
    terms.material     = sums[7];
    terms.closing      = sums[8];
    // of the work of contact, what its static forces do on the way
    if (initial_state.contact_force.size() > 0)
      terms.constraints -= 0.5 * (initial_state.contact_force * moved +
                                  initial_state.contact_force * moved_before);
    double work_on_cells = sums[6];
    if (force_at_rest.size() > 0)
      work_on_cells -=
        0.5 * (force_at_rest * moved + force_at_rest * moved_before);
    terms.memory = energy_of_branches(state);
    if (first)
      {
        initial          = terms.stored();
        initial_in_cells = in_cells + terms.memory - work_on_cells;
        first            = false;
      }
    terms.damping = sums[5] + work_on_cells + initial_in_cells - in_cells -
                    terms.memory - terms.material - terms.closing;
    most_damping = std::max(most_damping, terms.damping);

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
    constexpr double share = 0.01;
    if (!std::isfinite(terms_now.stored()))
      return "the motion is no longer finite (NaN or infinite)";
    if (terms_now.stored() > 100. * (largest_turnover + 1e-9))
      return "the stored energy has grown to a hundred times all energy that "
             "came in";
    if (terms_now.closing < -share * largest_turnover)
      return "cracks that close have made more than one per cent of all energy "
             "that came in";
    if (terms_now.damping < most_damping - share * largest_turnover)
      return "damping has given back more than one per cent of all energy that "
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
            {"lost by cracks that closed [J]", terms_now.closing},
            {"input [J]", terms_now.input},
            {"work of constraints [J]", terms_now.constraints},
            {"initial [J]", initial},
            {"unaccounted, share of the input", relative_error()},
            {"largest unaccounted share", largest_error}};
  }


  nlohmann::json
  EnergyBalance::save() const
  {
    return {{"initial", initial},
            {"initial in cells", initial_in_cells},
            {"most damping", most_damping},
            {"largest_turnover", largest_turnover},
            {"largest_error", largest_error}};
  }


  void
  EnergyBalance::load(const nlohmann::json &saved)
  {
    initial          = saved.at("initial");
    initial_in_cells = saved.at("initial in cells");
    most_damping     = saved.at("most damping");
    largest_turnover = saved.at("largest_turnover");
    largest_error    = saved.at("largest_error");
    first            = false;
  }
} // namespace Voussoir
