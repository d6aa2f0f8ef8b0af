#include <voussoir/base/mpi.h>
#include <voussoir/output/energy.h>

#include <iomanip>

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
    const InitialState &initial_state = equation.initial;
    if (initial_state.force.size() > 0)
      static_work = std::abs(initial_state.displacement * initial_state.force);
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

    // waves that pass through the rock are a thousand times what stays; neither
    // they nor the static energy may be known better than to their round-off
    const double net = terms.input - terms.boundary;
    came_in          = std::max({came_in,
                                 std::abs(net),
                                 std::abs(net + terms.constraints),
                                 1e-6 * terms.boundary,
                                 initial,
                                 1e-12 * static_work});
    largest_error    = std::max(largest_error, relative_error());
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
    /** What damping, which must not fall, has given back [J]. */
    double
    given_back(const EnergyTerms &terms, const double most_damping)
    {
      return std::max(most_damping - terms.damping, 0.);
    }


    /** What cracks made when they closed [J]. */
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
    return losses > 1e-3 * came_in ? made() / losses : 0.;
  }


  std::string
  EnergyBalance::alarm(const double limit) const
  {
    if (!std::isfinite(terms_now.stored()) || !std::isfinite(made()))
      return "the motion is no longer finite (NaN or infinite)";
    // an unstable step keeps the sum: strain energy falls as the kinetic grows,
    // as it does, within bounds, when parts fall
    if (std::max(terms_now.kinetic, terms_now.stored()) >
        100. * (came_in + static_work + 1e-9))
      return "the motion has grown to a hundred times all energy that came in";
    if (relative_error() > limit)
      {
        std::ostringstream text;
        text << std::setprecision(3) << 100. * relative_error()
             << " % of the energy that came in has come from nowhere ("
             << terms_now.error(initial) << " J unaccounted for, "
             << given_back(terms_now, most_damping)
             << " J given back by damping, " << made_by_closing(terms_now)
             << " J made by cracks that close)";
        return text.str();
      }
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
            {"from nowhere, share of the input", relative_error()},
            {"largest share from nowhere", largest_error},
            {"from nowhere, share of the losses", error_of_losses()}};
  }


  nlohmann::json
  EnergyBalance::save() const
  {
    return {{"initial", initial},
            {"initial in cells", initial_in_cells},
            {"most damping", most_damping},
            {"came in", came_in},
            {"largest error", largest_error}};
  }


  void
  EnergyBalance::load(const nlohmann::json &saved)
  {
    initial          = saved.at("initial");
    initial_in_cells = saved.at("initial in cells");
    most_damping     = saved.at("most damping");
    came_in          = saved.at("came in");
    largest_error    = saved.at("largest error");
    first            = false;
  }
} // namespace Voussoir
