#include <voussoir/analysis/contact_equilibrium.h>

#include <deal.II/base/timer.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int max_steps = 300, max_updates = 300;

    // of points that all hold together in the tangent: with nothing of it parts
    // that lie loose move away
    constexpr double tied_share = 1e-3;

    constexpr double report_interval = 5.; // [s]
  }                                        // namespace


  ContactEquilibrium::ContactEquilibrium(ElasticSolver       &solver,
                                         const InternalForce &internal_force,
                                         const NodalTerms    *springs,
                                         Log                 &log)
    : solver(solver)
    , contact(*solver.tangent_contact())
    , internal_force(internal_force)
    , springs(springs)
    , log(log)
  {}


  ContactEquilibrium::Effort
  ContactEquilibrium::find(Vector         &displacement,
                           MaterialMemory *memory,
                           const Vector   &force,
                           const double    tolerance)
  {
    // Of the linear equations of a step: smaller ones cost more than they save,
    // the more so if the elastic stiffness is not the tangent.
    const double linear_tolerance = memory == nullptr ? 0.05 : 0.3;
    Effort       effort;
    Timer        since_report;
    const Vector start  = displacement;
    Vector       change = force;
    solver.clear_held(change);
    residual              = change;
    const double size     = change.l2_norm();
    double       accuracy = 0.01;
    contact.start_stage();
    for (unsigned int update = 0;
         update < max_updates && effort.steps < max_steps;
         ++update)
      {
        double left = find_residual(displacement, memory, force);
        for (bool first = true;
             left > (first ? 0.1 * tolerance : accuracy) * size &&
             effort.steps < max_steps;
             first = false)
          {
            contact.stiffen(effort.steps == 0 ? 1. : tied_share);
            change = 0.;
            effort.iterations +=
              solver.solve(change, residual, linear_tolerance);
            ++effort.steps;
            displacement.add(length_of_step(displacement, change), change);
            left = find_residual(displacement, memory, force);
          }
        effort.last     = contact.update();
        effort.residual = size > 0. ? left / size : 0.;
        if (effort.residual <= 0.1 * tolerance &&
            effort.last.force <= tolerance && effort.last.broken == 0)
          {
            contact.finish_stage();
            effort.found = true;
            return effort;
          }
        // less, or multipliers and displacements run after each other
        accuracy =
          std::clamp(0.2 * effort.last.force, 0.1 * tolerance, accuracy);
        if (since_report.wall_time() > report_interval)
          {
            log.line("    after ",
                     effort.iterations,
                     " iterations: forces of contact still change by ",
                     100. * effort.last.force,
                     " %; ",
                     effort.last.open,
                     " of ",
                     effort.last.all,
                     " points are open, ",
                     effort.last.slide,
                     " slide");
            since_report.restart();
          }
      }
    contact.restore();
    displacement = start;
    return effort;
  }


  double
  ContactEquilibrium::find_residual(const Vector   &displacement,
                                    MaterialMemory *memory,
                                    const Vector   &force)
  {
    if (memory == nullptr)
      internal_force.apply(residual, displacement);
    else
      internal_force.respond(residual, displacement, *memory);
    if (springs != nullptr)
      springs->add_to(residual, displacement, 0.);
    residual.sadd(-1., 1., force);
    contact.respond(residual, displacement);
    solver.clear_held(residual);
    return residual.l2_norm();
  }


  double
  ContactEquilibrium::length_of_step(const Vector &displacement,
                                     const Vector &change) const
  {
    constexpr double       accuracy  = 0.1; // of the slope at the start
    constexpr unsigned int max_looks = 12;

    // all but contact is linear along the way
    Vector force = change, moved = change;
    internal_force.apply(force, change);
    if (springs != nullptr)
      springs->add_to(force, change, 0.);
    const double slope = change * residual, stiffness = change * force;
    const auto   work_of_contact = [&](const double way) {
      moved = displacement;
      moved.add(way, change);
      force = 0.;
      contact.respond(force, moved);
      return change * force;
    };
    const double work     = work_of_contact(0.);
    const auto   slope_at = [&](const double way) {
      return slope - way * stiffness + work_of_contact(way) - work;
    };

    // regula falsi, and now and then a half, as the slope has kinks
    double below = 0., above = 1., slope_below = slope,
           slope_above = slope_at(1.);
    if (slope_above >= -accuracy * slope)
      return 1.;
    for (unsigned int look = 1; look <= max_looks; ++look)
      {
        const double way =
          look % 3 == 0 ?
            0.5 * (below + above) :
            below + (above - below) * slope_below / (slope_below - slope_above);
        const double now = slope_at(way);
        if (std::abs(now) < accuracy * slope)
          return way;
        (now > 0. ? below : above)             = way;
        (now > 0. ? slope_below : slope_above) = now;
      }
    return below > 0. ? below : above;
  }
} // namespace Voussoir
