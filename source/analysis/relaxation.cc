#include <voussoir/analysis/relaxation.h>
#include <voussoir/base/error.h>
#include <voussoir/fem/nodal_values.h>
#include <voussoir/fem/stable_step.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int max_steps = 50000;

    // how often rest is looked for, in steps
    constexpr unsigned int look_interval = 20;
  } // namespace


  Relaxation::Relaxation(const Discretization            &discretization,
                         InternalForce                   &internal_force,
                         const LumpedMass                &mass_of_run,
                         const NodalTerms                &terms_of_run,
                         const AffineConstraints<double> &constraints,
                         const bool                       springs,
                         Contact                         *contact)
    : discretization(discretization)
    , internal_force(internal_force)
    , mass(mass_of_run)
    , terms(terms_of_run)
    , contact(contact)
  {
    for (unsigned int i = 0; i < mass.mass.locally_owned_size(); ++i)
      if (constraints.is_constrained(
            discretization.owned_dofs.nth_index_in_set(i)))
        mass.mass.local_element(i) = mass.inverse.local_element(i) = 0.;
    std::fill(terms.forces.begin(), terms.forces.end(), Tensor<1, 3>());
    std::fill(terms.dashpots.begin(),
              terms.dashpots.end(),
              NodalTerms::Matrix());
    if (!springs)
      std::fill(terms.springs.begin(),
                terms.springs.end(),
                NodalTerms::Matrix());
    time_step =
      0.9 * stable_step(discretization,
                        internal_force,
                        mass,
                        {[](const double) { return 0.; },
                         [&](Vector &force, const Vector &u, const double) {
                           terms.add_to(force, u, 0.);
                         }});
  }


  CentralDifference
  Relaxation::make_scheme(const double mass_coefficient)
  {
    DampingParameters none;
    none.model = "none";
    Damping damping(none);
    damping.mass_coefficient = mass_coefficient;
    return {discretization,
            internal_force,
            mass,
            damping,
            terms,
            loaded,
            contact != nullptr ? std::vector<Projection *>{contact} :
                                 std::vector<Projection *>{},
            [](const double) {},
            {},
            {},
            false,
            time_step};
  }


  double
  Relaxation::quarter_period(State &state, unsigned int &steps)
  {
    CentralDifference scheme  = make_scheme(0.);
    double            largest = 0.;
    if (contact != nullptr)
      contact->start(state);
    while (steps < max_steps)
      {
        scheme.step(state);
        ++steps;
        double kinetic = 0.;
        for (unsigned int i = 0; i < state.velocity.locally_owned_size(); ++i)
          kinetic += mass.mass.local_element(i) *
                     state.velocity.local_element(i) *
                     state.velocity.local_element(i);
        kinetic =
          Utilities::MPI::sum(kinetic, discretization.grid.communicator());
        largest = std::max(largest, kinetic);
        // a little below the top, so that fast small modes do not end it
        if (kinetic < 0.8 * largest || kinetic == 0.)
          break;
      }
    return state.time;
  }


  unsigned int
  Relaxation::find_equilibrium(Vector       &displacement,
                               const Vector &force,
                               const double  tolerance,
                               Log          &log)
  {
    loaded.displacement = displacement;
    loaded.force        = force;
    unsigned int steps  = 0;
    State        state  = make_scheme(0.).state_at_rest();
    const double period = 4. * quarter_period(state, steps);

    // critical damping 2 omega of the period; the motion goes on from here
    CentralDifference scheme = make_scheme(4. * numbers::PI / period);
    state.velocity           = 0.;
    if (contact != nullptr)
      contact->start(state);
    for (; steps < max_steps; ++steps)
      {
        scheme.step(state);
        if (steps % look_interval != 0)
          continue;
        const double moving = largest_amount(state.velocity) * period;
        if (moving <= tolerance * largest_amount(state.displacement))
          {
            displacement = state.displacement;
            if (contact != nullptr)
              contact->forget_approach();
            return steps;
          }
        if (!std::isfinite(moving))
          break;
        if (steps % (100 * look_interval) == 0)
          log.line("    after ",
                   steps,
                   " steps: motion of ",
                   1e3 * moving,
                   " mm in a period of ",
                   period,
                   " s");
      }
    throw UserError("The static state has not come to rest within 50000 steps: "
                    "under the static loads a block slides or falls, or cracks "
                    "or plastic flow do not end. Look at the strength of "
                    "interfaces and materials, and at the order of the "
                    "\"Stages\" in section \"Static state\".");
  }
} // namespace Voussoir
