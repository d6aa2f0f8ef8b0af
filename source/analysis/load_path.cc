#include <voussoir/analysis/equilibrium_search.h>
#include <voussoir/analysis/load_path.h>
#include <voussoir/analysis/lost_equilibrium.h>
#include <voussoir/base/text.h>
#include <voussoir/fem/notches.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Residual over the loads within a stage: a hundredth of the error of the
    // increments, 1e-3, suffices; and a trial is to show only whether
    // materials crack or yield.
    constexpr double on_the_path = 1e-5, on_trial = 1e-2;
  } // namespace


  StaticLoads
  StaticLoads::grown_to(const StaticLoads &end, const double share) const
  {
    StaticLoads result = end;
    if (share < 1.)
      {
        result.force.sadd(share, 1. - share, force);
        result.temperature.sadd(share, 1. - share, temperature);
        for (unsigned int k = 0; k < uplift.size(); ++k)
          result.uplift[k] += (1. - share) * (uplift[k] - end.uplift[k]);
      }
    return result;
  }


  LoadPath::LoadPath(const StaticModel      &model,
                     const StaticParameters &parameters,
                     InitialState           &state,
                     Log                    &log)
    : model(model)
    , parameters(parameters)
    , state(state)
    , log(log)
    , materials(for_each_material(model.solid.materials,
                                  [](const Material &material) {
                                    return &material.at_rest();
                                  }))
    , internal_force(model.solid.discretization,
                     {materials.begin(), materials.end()},
                     for_each_material(model.solid.materials,
                                       [](const Material &material) {
                                         return material.factor_at_rest();
                                       }))
    , on_springs(parameters.supports == StaticSupports::springs)
    , constraints(model.solid.discretization.make_constraints(
        on_springs ? model.boundaries.supports.list() :
                     model.boundaries.supports_with_absorbing(
                       parameters.supports == StaticSupports::roller)))
    , damping(Damping::none())
    , cracks(model.solid.discretization,
             {materials.begin(), materials.end()},
             internal_force,
             damping)
  {
    state.displacement = state.force =
      model.solid.discretization.create_vector();
    state.material_memory = internal_force.new_memory();
    weaken_at_notches(model.solid.discretization,
                      {materials.begin(), materials.end()},
                      state.material_memory);
  }


  void
  LoadPath::set_up()
  {
    const Timer clock;
    make_solver();
    if (model.contact != nullptr || internal_force.has_memory())
      relaxation = std::make_unique<Relaxation>(model.solid.discretization,
                                                internal_force,
                                                cracks,
                                                model.solid.mass,
                                                model.terms,
                                                constraints,
                                                on_springs,
                                                model.contact);
    log.line("Static state by multigrid, set up in ",
             duration_text(clock.wall_time()));
  }


  void
  LoadPath::make_solver()
  {
    ElasticSolver::Additions additions;
    additions.springs      = on_springs ? &model.terms : nullptr;
    additions.contact      = model.contact;
    additions.displacement = &state.displacement;
    solver = std::make_unique<ElasticSolver>(model.solid.discretization,
                                             internal_force,
                                             materials,
                                             constraints,
                                             additions);
  }


  void
  LoadPath::begin_stage(const std::vector<std::string> &loads)
  {
    ++number;
    stage  = join(loads, ", ");
    before = state.displacement;
    effort = {};
    secants.clear();
    if (!solver)
      make_solver();
  }


  void
  LoadPath::ties_have_changed()
  {
    solver.reset();
  }


  LoadPath::Effort
  LoadPath::follow(const StaticLoads &start, const StaticLoads &end)
  {
    find_path(start, end);
    // f(u) minus loads and contact are the reactions
    internal_force.respond(state.force,
                           state.displacement,
                           state.material_memory);
    state.force -= total_force(end);
    if (model.contact != nullptr)
      model.contact->add_forces(-1., state.force);
    return effort;
  }


  StressModel
  LoadPath::stress_model() const
  {
    return {model.solid.discretization,
            materials,
            internal_force,
            damping,
            state.material_memory,
            state,
            1.};
  }


  double
  LoadPath::dissipation() const
  {
    return dissipation(state.material_memory);
  }


  Vector
  LoadPath::total_force(const StaticLoads &loads) const
  {
    Vector force = loads.force;
    internal_force.add_thermal_force(force, loads.temperature);
    return force;
  }


  void
  LoadPath::find_path(const StaticLoads &start, const StaticLoads &end)
  {
    constexpr double tolerance = 1e-2, least_step = 1. / 64.;

    // at once, unless materials crack or yield
    const double largest_step = 1. / parameters.increments;
    bool         is_trial = internal_force.has_memory() && largest_step < 1.;
    double       step = 1., largest_error = 0.;
    unsigned int n_jumps = 0;
    Vector       rate; // derivative of the displacement by the share, if known
    since_start.restart();
    for (double share = 0.; share < 1.;)
      {
        const double      next  = share + step > 1. - 1e-9 ? 1. : share + step;
        const StaticLoads begin = start.grown_to(end, share),
                          goal  = start.grown_to(end, next);
        const Vector displacement_before = state.displacement;
        const auto   memory_before       = state.material_memory;
        const auto   points_before       = contact_points();
        step = next - share; // half of which is tried after a rejection
        if (rate.size() > 0)
          state.displacement.add(step, rate);
        increment = {{share, next}};
        may_be_halved =
          internal_force.has_memory() && !is_trial && step > least_step;
        is_found = true;

        const auto find = [&](const double asked) {
          accuracy = asked;
          find_equilibrium(goal, is_trial);
          return is_found && dissipated(state.material_memory,
                                        memory_before.losses().material);
        };
        bool has_dissipated = is_trial && find(on_trial);
        if (!has_dissipated)
          has_dissipated = find(next < 1. || may_be_halved ? on_the_path : 0.);
        double error = 0.;
        if (!is_found || (has_dissipated && is_trial))
          error = 1.;
        else if (has_dissipated)
          error = error_of_return_mapping(displacement_before,
                                          memory_before,
                                          begin.grown_to(goal, 0.5),
                                          goal);
        // only an increment that is not to be halved is worth the full accuracy
        if (next == 1. && may_be_halved && error <= tolerance)
          {
            has_dissipated = find(0.) || has_dissipated;
            if (!is_found)
              error = 1.;
          }
        if (error <= tolerance || (!is_trial && step <= least_step))
          {
            if (has_dissipated)
              count_losses(displacement_before, memory_before, begin, goal);
            if (!is_trial)
              {
                rate = state.displacement;
                rate -= displacement_before;
                rate /= step;
                if (next < 1.)
                  log.line("    ",
                           100. * next,
                           " % of the loads of the stage, the rest in about ",
                           duration_text(since_start.wall_time() * (1. - next) /
                                         next));
              }
            share = next;
            ++effort.increments;
            n_jumps += error > tolerance;
            largest_error = std::max(largest_error, error);
            // after a sudden crack longer increments suffice again
            step = std::min(error < 0.25 * tolerance ? 2. * step : step,
                            largest_step);
            continue;
          }
        rate.reinit(0);
        if (!is_trial)
          step *= 0.5;
        else
          {
            since_start.restart();
            is_trial = false;
            step =
              elastic_share(displacement_before, memory_before, start, end);
            if (step > 0.)
              {
                rate = state.displacement;
                rate -= displacement_before;
              }
            step = std::max(step, largest_step);
          }
        state.displacement    = displacement_before;
        state.material_memory = memory_before;
        secants.clear(); // of a structure that has cracked further
        if (model.contact != nullptr)
          model.contact->set_points(points_before);
      }
    if (n_jumps > 0)
      log.warn(
        "in the stage \"",
        stage,
        "\" ",
        counted(n_jumps, "load increment", "load increments"),
        " of ",
        100. * least_step,
        " % change the forces of the materials by up to ",
        100. * largest_error,
        " % of the loads against two of half the size, as where a crack "
        "grows suddenly; take more stages, or more \"Load increments\" in "
        "section \"Static state\"");
  }


  double
  LoadPath::elastic_share(const Vector         &before,
                          const MaterialMemory &memory,
                          const StaticLoads    &start,
                          const StaticLoads    &end) const
  {
    Vector force(before), displacement(before);
    for (unsigned int n = parameters.increments - 1; n > 0; --n)
      {
        const double   share = double(n) / parameters.increments;
        MaterialMemory tried = memory;
        displacement         = before;
        displacement.sadd(1. - share, share, state.displacement);
        internal_force.set_thermal_strain(
          start.grown_to(end, share).temperature, tried);
        internal_force.respond(force, displacement, tried);
        if (!dissipated(tried, memory.losses().material))
          return share;
      }
    return 0.;
  }


  void
  LoadPath::find_equilibrium(const StaticLoads &loads, const bool is_trial)
  {
    const Vector force  = total_force(loads);
    auto         points = contact_points();
    for (unsigned int k = 0; k < points.size(); ++k)
      points[k].uplift = loads.uplift[k];
    if (model.contact != nullptr)
      model.contact->set_points(points);
    if (!dissipated(state.material_memory))
      find_elastic_equilibrium(force);
    if (internal_force.has_memory())
      {
        internal_force.set_thermal_strain(loads.temperature,
                                          state.material_memory);
        crack_and_yield(force, points, is_trial);
        internal_force.respond(state.force,
                               state.displacement,
                               state.material_memory);
      }
    if (!std::isfinite(state.displacement.l2_norm() + state.force.l2_norm()))
      throw LostEquilibrium(
        "The static stage \"" + stage +
          "\" comes to no equilibrium: displacements or "
          "forces are no longer finite (NaN or infinite). "
          "Check the strength of the materials and the loads of the stage.",
        before,
        before);
  }


  double
  LoadPath::error_of_return_mapping(const Vector      &before,
                                    MaterialMemory     memory,
                                    const StaticLoads &middle,
                                    const StaticLoads &end) const
  {
    Vector displacement = before;
    displacement.sadd(0.5, 0.5, state.displacement);
    Vector in_two(displacement), at_once(displacement);
    memory.take_tips(state.material_memory);
    internal_force.set_thermal_strain(middle.temperature, memory);
    internal_force.respond(in_two, displacement, memory);
    internal_force.set_thermal_strain(end.temperature, memory);
    internal_force.respond(in_two, state.displacement, memory);

    memory = state.material_memory;
    internal_force.respond(at_once, state.displacement, memory);
    in_two -= at_once;
    constraints.set_zero(in_two);
    const double size = total_force(end).l2_norm();
    return size > 0. ? in_two.l2_norm() / size : 0.;
  }


  void
  LoadPath::count_losses(const Vector         &before,
                         const MaterialMemory &memory,
                         const StaticLoads    &begin,
                         const StaticLoads    &end)
  {
    constexpr double       tolerance   = 0.01;
    constexpr unsigned int max_steps   = 64;
    const double           lost_before = dissipation(memory);
    double lost = dissipation(state.material_memory) - lost_before;
    Vector force(before), displacement(before);
    for (unsigned int n = 2; n <= max_steps; n *= 2)
      {
        MaterialMemory in_steps = memory;
        in_steps.take_tips(state.material_memory);
        for (unsigned int i = 1; i <= n; ++i)
          {
            const double share = double(i) / n;
            displacement       = before;
            displacement.sadd(1. - share, share, state.displacement);
            internal_force.set_thermal_strain(
              begin.grown_to(end, share).temperature, in_steps);
            internal_force.respond(force, displacement, in_steps);
          }
        state.material_memory.set_losses(in_steps.losses());
        const double now  = dissipation(in_steps) - lost_before,
                     more = std::abs(now - lost);
        lost              = now;
        if (more <= tolerance * lost)
          break;
      }
  }


  std::vector<ContactPoint>
  LoadPath::contact_points() const
  {
    return model.contact != nullptr ? model.contact->points() :
                                      std::vector<ContactPoint>();
  }


  void
  LoadPath::find_elastic_equilibrium(const Vector &force)
  {
    if (model.contact != nullptr)
      search_equilibrium(force, nullptr);
    else
      effort.iterations +=
        solver->solve(state.displacement,
                      force,
                      std::max(parameters.tolerance, accuracy));
  }


  void
  LoadPath::crack_and_yield(const Vector                    &force,
                            const std::vector<ContactPoint> &before,
                            const bool                       is_trial)
  {
    if (!dissipated(state.material_memory))
      {
        MaterialMemory tried = state.material_memory;
        internal_force.respond(state.force, state.displacement, tried);
        if (is_trial || !dissipated(tried))
          {
            state.material_memory = std::move(tried);
            return;
          }
        log.line("  materials crack or yield");
        // interfaces return to the beginning of the stage, as the load path
        // does
        if (model.contact != nullptr)
          model.contact->set_points(before);
      }
    search_equilibrium(force, &state.material_memory);
  }


  void
  LoadPath::relax(const Vector &force, MaterialMemory &memory)
  {
    const Relaxation::Result motion = relaxation->find_equilibrium(
      state.displacement, memory, force, parameters.rest, log);
    effort.damped_steps += motion.steps;
    if (!motion.at_rest)
      throw LostEquilibrium(
        "The static stage \"" + stage + "\" comes to no equilibrium: after " +
          std::to_string(motion.steps) + " steps of dynamic relaxation " +
          description_of_motion(model.solid.discretization,
                                model.contact,
                                before,
                                state.displacement,
                                dissipated(memory)) +
          ". Check the strength of these interfaces and materials, the "
          "supports of the blocks, and the loads and the order of the "
          "\"Stages\" in section \"Static state\".",
        before,
        state.displacement);
    log.line("    at rest after ",
             motion.steps,
             " steps of dynamic relaxation");
  }


  void
  LoadPath::search_equilibrium(const Vector &force, MaterialMemory *memory)
  {
    const double tolerance =
      std::max(model.contact != nullptr ? 0.1 * parameters.rest :
                                          std::max(parameters.tolerance, 1e-8),
               accuracy);
    // a long crack takes several steps for each cell along it
    const unsigned int patience =
      memory != nullptr && may_be_halved ? 100 : 300;
    const EquilibriumSearch::Effort search =
      EquilibriumSearch(*solver,
                        internal_force,
                        cracks,
                        on_springs ? &model.terms : nullptr,
                        force,
                        tolerance,
                        patience,
                        secants,
                        [this](const double share, const std::string &text) {
                          report_progress(share, text);
                        })
        .find(state.displacement, memory);
    std::ostringstream text;
    text << std::setprecision(2) << "    by multigrid: " << search.iterations
         << " iterations in " << search.steps << " steps, ";
    if (!std::isfinite(search.residual))
      text << "whose forces are not finite";
    else
      {
        text << "equilibrium to " << search.residual;
        if (model.contact != nullptr)
          text << ", forces of contact to " << search.contact.force;
      }
    is_found = search.found || memory == nullptr || !may_be_halved;
    if (!search.found)
      text << "; not found, so "
           << (is_found ? "by dynamic relaxation" : "in two load increments");
    log.line(text.str());
    effort.iterations += search.iterations;
    if (!is_found)
      return;
    MaterialMemory none;
    if ((model.contact != nullptr && accuracy == 0.) || !search.found)
      relax(force, memory == nullptr ? none : *memory);
    effort.by_multigrid = effort.by_multigrid && search.found;
  }


  double
  LoadPath::dissipation(const MaterialMemory &memory) const
  {
    return Utilities::MPI::sum<double>(memory.losses().material,
                                       model.solid.grid().communicator());
  }


  bool
  LoadPath::dissipated(const MaterialMemory &memory, const double before) const
  {
    return Utilities::MPI::max(memory.losses().material - before,
                               model.solid.grid().communicator()) > 0.;
  }


  void
  LoadPath::report_progress(const double share, const std::string &text)
  {
    if (!log.progress_is_due())
      return;
    const double done = increment[0] + share * (increment[1] - increment[0]);
    std::ostringstream line;
    line << "of static stage " << number << " of "
         << parameters.stage_names().size() << ": " << text;
    // a first trial may end with the need for load increments
    if (done > 0. && !(internal_force.has_memory() && increment[0] == 0.))
      line << ", time left in it "
           << duration_text(since_start.wall_time() * (1. - done) / done);
    log.progress(done, line.str());
  }
} // namespace Voussoir
