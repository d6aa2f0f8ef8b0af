#include <voussoir/base/error.h>
#include <voussoir/driver/time_step.h>
#include <voussoir/fem/stable_step.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // The limit with the same damping of all materials, (dt/dt_0)^2 (1 +
    // gamma(dt) + 2 beta/dt) = 1 with the undamped dt_0, by three
    // substitutions.
    double
    damped_step(const Damping &damping, const double undamped_limit)
    {
      double dt = undamped_limit;
      for (unsigned int i = 0; i < 3; ++i)
        dt = undamped_limit / std::sqrt(1. + damping.stiffening(dt) +
                                        2. * damping.mesh_viscosity / dt);
      return dt;
    }


    double
    limit_with_damping(const Model         &model,
                       const InternalForce &internal_force,
                       const Damping       &damping,
                       const double         undamped_limit,
                       const bool           central)
    {
      const double alpha = damping.mass_coefficient;
      StepLimits   limits;
      limits.stiffening = [&](const double dt) {
        return damping.stiffening(dt);
      };
      limits.mesh_viscosity = damping.mesh_viscosity;
      if (undamped_limit > 0.)
        limits.guess = damped_step(damping, undamped_limit);
      limits.add_diagonal =
        [&](Vector &force, const Vector &displacement, const double dt) {
          model.terms.add_to(force, displacement, central ? 0. : 2. / dt);
          if (!central && alpha > 0.)
            for (unsigned int i = 0; i < force.locally_owned_size(); ++i)
              force.local_element(i) += 2. / dt * alpha *
                                        model.solid.mass.mass.local_element(i) *
                                        displacement.local_element(i);
          if (model.reservoir)
            model.reservoir->add_coupling(force, displacement, dt);
        };
      const double step = stable_step(model.solid.discretization,
                                      internal_force,
                                      model.solid.mass,
                                      limits);
      // the bound on the coupling holds up to this share of the water's limit
      return model.reservoir ?
               std::min(step, 0.95 * model.reservoir->stable_step()) :
               step;
    }


    double
    fitted_step(const double step, const double interval)
    {
      const double whole = interval / std::ceil(interval / step - 1e-9);
      return whole > 0.9 * step ? whole : step;
    }


    double
    chosen_step(const TimeParameters &parameters,
                const double          limit,
                const double          interval)
    {
      const double given = parameters.time_step;
      if (given > limit)
        {
          std::ostringstream text;
          text << std::setprecision(3)
               << "\"Time step\" in section \"Time\" is " << given
               << " s, but the largest stable one is " << limit
               << " s; choose a smaller one, or 0 for the automatic choice.";
          throw UserError(text.str());
        }
      return given > 0. ?
               given :
               fitted_step(parameters.safety_factor * limit, interval);
    }


    void
    check_number_of_steps(const double end_time, const double step)
    {
      constexpr double most = 1e10; // years on any machine
      if (end_time <= most * step)
        return;
      std::ostringstream text;
      text << std::setprecision(3) << "\"End time\" in section \"Time\" is "
           << end_time << " s, which takes " << end_time / step
           << " steps of the time step of " << step
           << " s, more than can be computed; give a shorter \"End time\" or a "
              "larger \"Time step\".";
      throw UserError(text.str());
    }
  } // namespace


  double
  undamped_step(const Model &model, const InternalForce &internal_force)
  {
    return stable_step(model.solid.discretization,
                       internal_force,
                       model.solid.mass,
                       {});
  }


  TimeStep::TimeStep(const Model                 &model,
                     const InternalForce         &internal_force,
                     const Damping               &damping,
                     const double                 undamped_limit,
                     const std::optional<double> &kept,
                     const double                 interval,
                     Log                         &log)
    : central(model.parameters.time.scheme != TimeScheme::paper)
  {
    std::vector<double> density;
    for (const Material *material : model.solid.materials)
      density.push_back(material->inertial_density());
    std::ostringstream text;
    ElementSteps(model.solid.discretization, internal_force, density)
      .print(text);
    log(text.str());

    const bool cracks = internal_force.has_memory();
    limit             = limit_with_damping(
      model, internal_force, damping, undamped_limit, central);
    if (!std::isfinite(limit))
      throw UserError(
        "The model cannot move, because the supports of section \"Boundaries\" "
        "fix all of its nodes; fix fewer face sets, or refine the mesh.");
    length = kept ? *kept : chosen_step(model.parameters.time, limit, interval);
    check_number_of_steps(model.parameters.time.end_time, length);
    if (cracks)
      {
        // a spring k with a dashpot c k is stable up to x^2 + 2 x c/dt_0 = 1
        // with x = dt/dt_0
        const double x = std::min(0.999, length / undamped_limit);
        closing_viscosity =
          undamped_limit * std::min(0.2, 0.95 * (1. - x * x) / (2. * x));
      }

    std::ostringstream line;
    damping.print(line);
    if (cracks && damping.stiffening(1.) == 0.)
      line << "  note: materials can crack or yield, and this model of "
              "damping hardly damps the short waves of sudden cracks, which "
              "cause more cracks: their number is unreliable. \"Model = "
              "Maxwell\" damps these waves.\n";
    line << std::setprecision(4) << "Time step: " << length
         << " s, largest stable " << limit << " s";
    if (undamped_limit > 0.)
      line << " (" << std::setprecision(3) << 100. * limit / undamped_limit
           << " % of the undamped " << std::setprecision(4) << undamped_limit
           << " s)";
    const double end_time = model.parameters.time.end_time;
    line << ", " << steps_to(end_time) << " steps to " << end_time << " s\n";
    if (model.parameters.modes.number > 0 && !model.parameters.moves())
      line << "Nothing moves the model: no time steps.\n";
    log(line.str());
  }


  unsigned long long
  TimeStep::steps_to(const double time) const
  {
    return std::ceil(time / length - 1e-9);
  }
} // namespace Voussoir
