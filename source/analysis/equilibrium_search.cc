#include <voussoir/analysis/equilibrium_search.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int max_updates = 300;

    // share of the tangent with all points sticking, without which parts that
    // have no other support move away
    constexpr double tied_share = 1e-3;

    // residual over the loads at which cracks are continued
    constexpr double while_cracks_grow = 1e-3;
  } // namespace


  EquilibriumSearch::EquilibriumSearch(ElasticSolver       &solver,
                                       const InternalForce &internal_force,
                                       StaticCracks        &cracks,
                                       const NodalTerms    *springs,
                                       const Vector        &force,
                                       const double         tolerance,
                                       const unsigned int   patience,
                                       SecantSteps         &secants,
                                       const Report        &report)
    : solver(solver)
    , contact(solver.tangent_contact())
    , internal_force(internal_force)
    , cracks(cracks)
    , springs(springs)
    , force(force)
    , tolerance(tolerance)
    , patience(patience)
    , secants(secants)
    , report(report)
    , residual(force)
    , change(force)
    , taken(force)
  {
    solver.clear_constrained(residual);
    size = residual.l2_norm();
  }


  EquilibriumSearch::Effort
  EquilibriumSearch::find(Vector         &displacement_of_state,
                          MaterialMemory *memory_of_state)
  {
    displacement       = &displacement_of_state;
    memory             = memory_of_state;
    const Vector start = *displacement;
    if (memory != nullptr)
      memory_before = *memory;
    if (contact != nullptr)
      contact->start_stage();

    try
      {
        follow_cracks();
      }
    catch (const NotSolved &)
      {
        if (effort.steps == 1) // with all parts tied
          throw;
      }
    if (effort.found && contact != nullptr)
      contact->finish_stage();
    if (!effort.found)
      {
        *displacement = start;
        secants.clear();
        if (memory != nullptr)
          *memory = before_tips ? *before_tips : memory_before;
        if (contact != nullptr)
          contact->restore();
      }
    return effort;
  }


  void
  EquilibriumSearch::follow_cracks()
  {
    double aim =
      memory == nullptr ? tolerance : std::max(tolerance, while_cracks_grow);
    for (approach(aim); effort.found; approach(aim))
      {
        if (!find_tips())
          {
            if (aim == tolerance)
              return;
            aim = tolerance;
          }
        effort.found    = false;
        least_imbalance = std::numeric_limits<double>::max();
        last_gain       = effort.steps;
      }
  }


  bool
  EquilibriumSearch::find_tips()
  {
    const bool along_interfaces = contact != nullptr && contact->find_tips();
    const bool in_cells =
      memory != nullptr && cracks.propagate(*displacement, *memory);
    if (in_cells)
      {
        if (!before_tips)
          before_tips = memory_before;
        memory_before.take_tips(*memory);
      }
    return along_interfaces || in_cells;
  }


  void
  EquilibriumSearch::approach(const double aim)
  {
    double accuracy = 0.01;
    for (unsigned int update = 0;
         update < max_updates && is_worth_it() && !effort.found;
         ++update)
      {
        find_residual();
        if (update == 0)
          first_imbalance = effort.residual;
        balance(contact == nullptr ? aim : accuracy, aim);
        effort.found = effort.residual <= aim;
        if (contact == nullptr)
          continue;
        effort.contact = contact->update();
        effort.found   = effort.found && effort.contact.force <= 10. * aim &&
                       effort.contact.broken == 0;
        // must be below the tolerance of the multipliers: otherwise both
        // iterations alternate without converging
        accuracy = std::clamp(0.2 * effort.contact.force, aim, accuracy);
      }
  }


  void
  EquilibriumSearch::balance(const double accuracy, const double aim)
  {
    // With friction that follows the pressure the iterations may repeat in a
    // cycle, which an update of the multipliers ends.
    constexpr unsigned int max_steps_of_update = 10;
    for (unsigned int steps = 0;
         effort.residual > (steps == 0 ? 0.1 * aim : accuracy) &&
         (contact == nullptr || steps < max_steps_of_update) && is_worth_it();
         ++steps)
      {
        step();
        if (imbalance() < 0.5 * least_imbalance)
          {
            least_imbalance = imbalance();
            last_gain       = effort.steps;
          }
        report_progress();
      }
  }


  void
  EquilibriumSearch::step()
  {
    constexpr unsigned int max_evaluations = 12;
    constexpr double       max_way = 16., accuracy = 0.1; // of the slope

    // Smaller steps cost more than they save, the more so if the elastic
    // stiffness is not the tangent.
    const double linear_tolerance = memory == nullptr ? 0.05 : 0.3;

    if (contact != nullptr)
      contact->stiffen(effort.steps == 0 && secants.empty() ? 1. : tied_share);
    ++effort.steps;
    secants.find(change, residual, [&](Vector &step, const Vector &part) {
      step = 0.;
      effort.iterations += solver.solve(step, part, linear_tolerance);
    });

    // Line search for a zero of the slope: beyond a full step where materials
    // soften, then by regula falsi, and sometimes by bisection, as the slope
    // has kinks.
    taken              = residual;
    const double slope = change * residual;
    double       below = 0., above = 0., slope_below = slope, slope_above = 0.;
    double       way      = 0.;
    const auto   evaluate = [&](const double next) {
      displacement->add(next - way, change);
      way = next;
      find_residual();
      const double now                       = change * residual;
      (now > 0. ? below : above)             = way;
      (now > 0. ? slope_below : slope_above) = now;
      return now;
    };
    double now = evaluate(1.);
    for (unsigned int evaluations = 1;
         evaluations < max_evaluations && (above > 0. || way < max_way) &&
         std::abs(now) > accuracy * slope;
         ++evaluations)
      if (above == 0.)
        now = evaluate(
          std::min(max_way,
                   way * (now < 0.75 * slope ? slope / (slope - now) : 4.)));
      else if (evaluations % 3 == 0)
        now = evaluate(0.5 * (below + above));
      else
        now = evaluate(below + (above - below) * slope_below /
                                 (slope_below - slope_above));
    if (memory == nullptr)
      return; // the tangent of contact has been evaluated
    taken -= residual;
    change *= way;
    secants.add(change, taken);
  }


  void
  EquilibriumSearch::find_residual()
  {
    if (memory == nullptr)
      internal_force.apply(residual, *displacement);
    else
      {
        *memory = memory_before;
        internal_force.respond(residual, *displacement, *memory);
      }
    if (springs != nullptr)
      springs->add_to(residual, *displacement, 0.);
    residual.sadd(-1., 1., force);
    if (contact != nullptr)
      contact->respond(residual, *displacement);
    solver.clear_constrained(residual);
    effort.residual = size > 0. ? residual.l2_norm() / size : 0.;
  }


  double
  EquilibriumSearch::imbalance() const
  {
    return std::max(effort.residual, 0.1 * effort.contact.force);
  }


  bool
  EquilibriumSearch::is_worth_it() const
  {
    return effort.steps < last_gain + patience;
  }


  void
  EquilibriumSearch::report_progress() const
  {
    // the residual falls by about the same factor in each step
    const double done =
      first_imbalance > tolerance ?
        std::clamp(std::log(first_imbalance / least_imbalance) /
                     std::log(first_imbalance / tolerance),
                   0.,
                   1.) :
        0.;
    std::ostringstream text;
    text << std::setprecision(2) << effort.iterations
         << " iterations, equilibrium to " << effort.residual << " of "
         << tolerance;
    if (contact != nullptr)
      text << ", forces of contact to " << effort.contact.force << " of "
           << 10. * tolerance << " (" << effort.contact.open << " of "
           << effort.contact.all << " points are open, " << effort.contact.slide
           << " slide)";
    report(done, text.str());
  }
} // namespace Voussoir
