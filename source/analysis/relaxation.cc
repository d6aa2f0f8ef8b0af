#include <voussoir/analysis/relaxation.h>
#include <voussoir/base/interruption.h>
#include <voussoir/base/mpi.h>
#include <voussoir/fem/nodal_values.h>
#include <voussoir/fem/stable_step.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int max_steps = 50000;

    // steps between two checks of convergence
    constexpr unsigned int check_interval = 20;


    /** Diagonal of the bounding box of the model [m]. */
    double
    diagonal_of(const Discretization &discretization)
    {
      std::vector<double> upper(6, std::numeric_limits<double>::lowest());
      for (const Point<3> &x : discretization.node_positions)
        for (unsigned int d = 0; d < 3; ++d)
          {
            upper[d]     = std::max(upper[d], x[d]);
            upper[3 + d] = std::max(upper[3 + d], -x[d]);
          }
      Utilities::MPI::max(upper, discretization.grid.communicator(), upper);
      return std::hypot(upper[0] + upper[3],
                        upper[1] + upper[4],
                        upper[2] + upper[5]);
    }
  } // namespace


  Relaxation::Relaxation(const Discretization            &discretization,
                         const InternalForce             &internal_force,
                         StaticCracks                    &cracks,
                         const LumpedMass                &mass_of_run,
                         const NodalTerms                &terms_of_run,
                         const AffineConstraints<double> &constraints,
                         const bool                       springs,
                         Contact                         *contact)
    : discretization(discretization)
    , internal_force(internal_force)
    , cracks(cracks)
    , mass(mass_of_run)
    , terms(terms_of_run)
    , damping(Damping::none())
    , contact(contact)
    , extent(diagonal_of(discretization))
  {
    for (unsigned int i = 0; i < mass.mass.locally_owned_size(); ++i)
      if (constraints.is_constrained(
            discretization.owned_dofs.nth_index_in_set(i)))
        mass.mass.local_element(i) = mass.inverse.local_element(i) = 0.;
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
                        {{}, [&](Vector &force, const Vector &u, const double) {
                           terms.add_to(force, u, 0.);
                         }});
  }


  std::unique_ptr<CentralDifference>
  Relaxation::make_scheme(const double mass_coefficient)
  {
    damping.mass_coefficient = mass_coefficient;
    EquationOfMotion equation{
      discretization, internal_force, mass, terms, damping, loaded};
    if (contact != nullptr)
      equation.projections.push_back(contact);
    equation.crack_tips   = &cracks.tips;
    equation.crack_planes = &cracks.planes;
    return std::make_unique<CentralDifference>(equation, LeapFrog{time_step});
  }


  double
  Relaxation::natural_frequency(const std::array<Vector, 3> &velocity,
                                const double mass_coefficient) const
  {
    double stiffness = 0., inertia = 0.;
    for (unsigned int i = 0; i < mass.mass.locally_owned_size(); ++i)
      {
        const double before = velocity[0].local_element(i),
                     now    = velocity[1].local_element(i),
                     after  = velocity[2].local_element(i),
                     m      = mass.mass.local_element(i);
        stiffness -= m * now *
                     ((after - 2. * now + before) / (time_step * time_step) +
                      mass_coefficient * (after - before) / (2. * time_step));
        inertia += m * now * now;
      }
    const auto sums = sum_over_ranks(std::vector<double>{stiffness, inertia},
                                     discretization.grid.communicator());
    return sums[1] > 0. ? std::sqrt(std::max(sums[0] / sums[1], 0.)) : 0.;
  }


  bool
  Relaxation::too_far(const Vector &displacement) const
  {
    double apart = 0.;
    if (contact != nullptr)
      for (const ContactPoint &point : contact->points())
        apart = std::max(apart, (point.gap - point.initial_gap).norm());
    return Utilities::MPI::max(apart, discretization.grid.communicator()) >
             (contact != nullptr ? contact->cell_size() : 0.) ||
           largest_amount(displacement) > 0.01 * extent;
  }


  Relaxation::Result
  Relaxation::find_equilibrium(Vector         &displacement,
                               MaterialMemory &memory,
                               const Vector   &force,
                               const double    tolerance,
                               Log            &log)
  {
    loaded.displacement = displacement;
    loaded.force        = force;

    // from rest, undamped until the first check
    double frequency = 0., mass_coefficient = 0.;
    auto   scheme         = make_scheme(0.);
    State  state          = scheme->initial_state();
    state.material_memory = std::move(memory);
    if (contact != nullptr)
      {
        contact->start(state);
        contact->begin_approach();
      }
    std::array<Vector, 3> velocity;
    Result                result;
    while (!result.at_rest && result.steps < max_steps)
      {
        scheme->step(state);
        const unsigned int steps = ++result.steps;
        const unsigned int to_check =
          (check_interval - steps % check_interval) % check_interval;
        if (to_check < 3)
          velocity[2 - to_check] = state.velocity;
        if (to_check > 0)
          continue;

        stop_if_requested(discretization.grid.communicator());
        const double speed = largest_amount(state.velocity);
        if (!std::isfinite(speed) || too_far(state.displacement))
          break;
        // friction and opening joints may give a negative quotient: the last
        // frequency is then kept
        const double measured = natural_frequency(velocity, mass_coefficient);
        if (measured > 0.)
          frequency = frequency == 0. ?
                        measured :
                        std::clamp(measured, 0.7 * frequency, 1.4 * frequency);
        const double period = 2. * numbers::PI / frequency;
        const double moving = speed == 0. ? 0. : speed * period;
        result.at_rest =
          moving <= tolerance * largest_amount(state.displacement);
        if (steps % (100 * check_interval) == 0)
          log.line("    after ",
                   steps,
                   " steps: motion of ",
                   1e3 * moving,
                   " mm in a period of ",
                   period,
                   " s");

        // critical damping of the remaining motion
        const double wanted = std::min(2. * frequency, 1. / time_step);
        if (std::abs(wanted - mass_coefficient) > 0.2 * mass_coefficient)
          {
            mass_coefficient = wanted;
            scheme           = make_scheme(wanted);
          }
      }
    displacement = state.displacement;
    memory       = std::move(state.material_memory);
    if (contact != nullptr && result.at_rest)
      contact->forget_approach();
    return result;
  }
} // namespace Voussoir
