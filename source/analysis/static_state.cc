#include <voussoir/analysis/equilibrium_search.h>
#include <voussoir/analysis/lost_equilibrium.h>
#include <voussoir/analysis/relaxation.h>
#include <voussoir/analysis/stage_results.h>
#include <voussoir/analysis/static_outline.h>
#include <voussoir/base/json_entries.h>
#include <voussoir/base/text.h>
#include <voussoir/fem/nodal_values.h>

#include <deal.II/base/timer.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    std::string
    meganewtons(const Tensor<1, 3> &force)
    {
      const double       round_off = 1e-12 * force.norm();
      std::ostringstream text;
      text << std::setprecision(5);
      for (unsigned int d = 0; d < 3; ++d)
        text << (d == 0 ? "(" : ", ")
             << (std::abs(force[d]) < round_off ? 0. : 1e-6 * force[d]);
      text << ") MN";
      return text.str();
    }


    // Forces and temperature of a load before the earthquake, on fixed nodes
    // too.
    Vector
    force_of(const Load           &load,
             const Discretization &discretization,
             const NodalTerms     &terms)
    {
      Vector      force = discretization.create_vector();
      NodalForces forces(terms);
      load.add_forces(0., forces);
      for (unsigned int slot = 0; slot < terms.nodes.size(); ++slot)
        for (unsigned int d = 0; d < 3; ++d)
          force.local_element(3 * terms.nodes[slot] + d) =
            forces.of_slot(slot)[d];
      load.add_steady_force(force);
      return force;
    }


    /** The stages of the static state: each adds its loads to those before and
     *  finds the equilibrium with all of them. */
    class StaticStages
    {
    public:
      StaticStages(const StaticModel      &model,
                   const StaticParameters &parameters,
                   Log                    &log);

      /** Sets up the equations. */
      void
      set_up();

      /** Applies a stage; returns its part of the summary. */
      nlohmann::json
      apply(const StaticParameters::Stage             &applied,
            const std::map<std::string, const Load *> &load_of);

      /** The summary of a stage, before equilibrium is found. */
      nlohmann::json
      outline(const StaticParameters::Stage             &applied,
              const std::map<std::string, const Load *> &load_of);

      /** State after the stages so far; its force is that of the supports. */
      InitialState state;

    private:
      void
      add_load(const std::string &name,
               const Load        &load,
               nlohmann::json    &report);

      /** Quantities that grow along a stage. */
      struct LoadState
      {
        Vector              loads, temperature;
        std::vector<double> uplift; // at the points of the interfaces [Pa]

        /** Linear interpolation to another one; at a share of one without
         *  round-off. */
        LoadState
        grown_to(const LoadState &end, const double share) const;
      };

      /** The present one. */
      LoadState
      load_state() const;

      /** Forces of the loads and the free thermal strain [N]. */
      Vector
      total_force(const LoadState &state) const;

      /** The linear equations, with the parts tied where they touch now. */
      void
      make_solver();

      /** Applies the loads of a stage in increments; returns the iterations. */
      unsigned int
      follow_path(const LoadState &start, const LoadState &end);

      /** Equilibrium with these loads; returns the iterations.
       *  @param is_trial whether it is enough to know that materials crack or
       *    yield, where they do */
      unsigned int
      find_equilibrium(const LoadState &load_state, const bool is_trial);

      /** Difference of the forces of the materials at the end of an increment
       *  between one step of the laws and two, over the loads.
       *  @param before displacement, @p memory before the increment
       *  @param middle, @p end of the increment */
      double
      error_of_return_mapping(const Vector    &before,
                              MaterialMemory   memory,
                              const LoadState &middle,
                              const LoadState &end) const;

      /** Sums up the dissipation of the materials in an increment over several
       *  steps of the laws: under stress in several directions the energy of a
       *  crack is that at the end of its step.
       *  @param before displacement, @p memory before the increment
       *  @param begin, @p end of the increment */
      void
      count_losses(const Vector         &before,
                   const MaterialMemory &memory,
                   const LoadState      &begin,
                   const LoadState      &end);

      /** Equilibrium of elastic materials. */
      unsigned int
      find_elastic_equilibrium(const Vector &force);

      /** Equilibrium with contact or with internal variables: by multigrid;
       *  dynamic relaxation finds it where multigrid does not, and checks that
       *  parts between interfaces are in equilibrium.
       *  @param memory of the materials; null: they are elastic */
      unsigned int
      search_equilibrium(const Vector &force, MaterialMemory *memory);

      /** Updates the internal variables of the materials to this state, and
       *  where they crack or yield restores equilibrium; returns the
       *  iterations.
       *  @param before contact at the beginning of the increment
       *  @param is_trial see find_equilibrium */
      unsigned int
      crack_and_yield(const Vector                    &force,
                      const std::vector<ContactPoint> &before,
                      const bool                       is_trial);

      /** The present state of the interfaces' points, or none. */
      std::vector<ContactPoint>
      contact_points() const;

      /** By dynamic relaxation. */
      void
      relax(const Vector &force, MaterialMemory &memory);

      /** Energy that materials have dissipated so far, on all ranks [J]. */
      double
      dissipation(const MaterialMemory &memory) const;

      /** Whether materials have dissipated more than this [J] on any rank:
       *  whether they have cracked or yielded since. */
      bool
      dissipated(const MaterialMemory &memory, const double before = 0.) const;

      /** Says how far the search is, of which this share is done. */
      void
      report_progress(const double share, const std::string &text);

      void
      report_equilibrium(const unsigned int iterations,
                         const double       seconds,
                         nlohmann::json    &report) const;

      const StaticModel                  &model;
      const StaticParameters             &parameters;
      Log                                &log;
      const std::vector<const Material *> materials; // of the static state
      const InternalForce                 internal_force;
      const bool                          on_springs;
      const AffineConstraints<double>     constraints;
      std::unique_ptr<ElasticSolver>      solver;
      std::unique_ptr<Relaxation>
                               relaxation; // with contact or internal variables
      SecantSteps              secants;    // along this stage
      const StageResults       results;
      const Damping            damping; // none
      Vector                   loads;   // so far [N]
      std::vector<std::string> stage;   // names of its loads
      Vector                   before;  // displacement before it [m]
      bool                     by_multigrid = true; // this stage
      unsigned int             number       = 0;    // of this stage
      Timer                    since_start;         // of its path
      std::array<double, 2>    increment;           // of its loads
      unsigned int             damped_steps = 0;    // of this stage
      unsigned int             increments   = 0;    // of this stage
      bool                     is_last      = true; // increment
      bool                     may_be_halved =
        false; // the increment that relaxation solves if the search does not
      bool is_found = true; // find its equilibrium
    };


    StaticStages::StaticStages(const StaticModel      &model,
                               const StaticParameters &parameters,
                               Log                    &log)
      : model(model)
      , parameters(parameters)
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
      , results(model.solid.discretization, parameters)
      , damping(Damping::none())
      , loads(model.solid.discretization.create_vector())
    {
      state.displacement = state.temperature = state.force = loads;
      state.material_memory = internal_force.new_memory();
    }


    void
    StaticStages::set_up()
    {
      const Timer clock;
      make_solver();
      if (model.contact != nullptr || internal_force.has_memory())
        relaxation = std::make_unique<Relaxation>(model.solid.discretization,
                                                  internal_force,
                                                  model.solid.mass,
                                                  model.terms,
                                                  constraints,
                                                  on_springs,
                                                  model.contact);
      log.line("Static state by multigrid, set up in ",
               duration_text(clock.wall_time()));
    }


    void
    StaticStages::make_solver()
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


    nlohmann::json
    StaticStages::apply(const StaticParameters::Stage             &applied,
                        const std::map<std::string, const Load *> &load_of)
    {
      ++number;
      stage  = applied.loads;
      before = state.displacement;
      const Timer    clock;
      nlohmann::json report;
      by_multigrid = true;
      damped_steps = increments = 0;
      secants.clear();
      if (!solver)
        make_solver();
      const LoadState start = load_state();
      for (const std::string &name : stage)
        add_load(name, *load_of.at(name), report);
      if (model.contact != nullptr)
        model.contact->apply_uplift(stage);
      const LoadState    end        = load_state();
      const unsigned int iterations = follow_path(start, end);

      // f(u) minus loads and contact are the reactions
      internal_force.respond(state.force,
                             state.displacement,
                             state.material_memory);
      state.force -= total_force(end);
      if (model.contact != nullptr)
        model.contact->add_forces(-1., state.force);
      report_equilibrium(iterations, clock.wall_time(), report);
      report["name"] = applied.title();
      state.stages.emplace_back(applied.title(), state.displacement);
      if (model.contact != nullptr &&
          model.contact->grout(stage, state.displacement))
        {
          state.grouted_displacement = state.displacement;
          solver.reset(); // other parts are tied now
        }
      return report;
    }


    nlohmann::json
    StaticStages::outline(const StaticParameters::Stage             &applied,
                          const std::map<std::string, const Load *> &load_of)
    {
      nlohmann::json report;
      for (const std::string &name : applied.loads)
        add_load(name, *load_of.at(name), report);
      report_equilibrium(0, 0., report);
      return report;
    }


    void
    StaticStages::add_load(const std::string &name,
                           const Load        &load,
                           nlohmann::json    &report)
    {
      const Vector force =
        force_of(load, model.solid.discretization, model.terms);
      load.add_temperature(state.temperature);
      const Tensor<1, 3> sum                 = resultant(force);
      report["loads"][name]["resultant [N]"] = to_json(sum);
      const auto  by_geometry                = load.resultant_of_geometry();
      std::string beside;
      if (by_geometry)
        {
          beside = ", by volumes and areas " + meganewtons(*by_geometry);
          report["loads"][name]["resultant by volumes and areas [N]"] =
            to_json(*by_geometry);
        }
      log.line("  load ", name, ": resultant ", meganewtons(sum), beside);
      loads += force;
    }


    StaticStages::LoadState
    StaticStages::LoadState::grown_to(const LoadState &end,
                                      const double     share) const
    {
      LoadState result = end;
      if (share < 1.)
        {
          result.loads.sadd(share, 1. - share, loads);
          result.temperature.sadd(share, 1. - share, temperature);
          for (unsigned int k = 0; k < uplift.size(); ++k)
            result.uplift[k] += (1. - share) * (uplift[k] - end.uplift[k]);
        }
      return result;
    }


    StaticStages::LoadState
    StaticStages::load_state() const
    {
      LoadState result{loads, state.temperature, {}};
      for (const ContactPoint &point : contact_points())
        result.uplift.push_back(point.uplift);
      return result;
    }


    Vector
    StaticStages::total_force(const LoadState &load_state) const
    {
      Vector force = load_state.loads;
      internal_force.add_thermal_force(force, load_state.temperature);
      return force;
    }


    unsigned int
    StaticStages::follow_path(const LoadState &start, const LoadState &end)
    {
      constexpr double tolerance = 1e-2, least_step = 1. / 64.;

      // at once, unless materials crack or yield
      const double largest_step = 1. / parameters.increments;
      double       step = 1., largest_error = 0.;
      unsigned int iterations = 0, n_jumps = 0;
      Vector
        rate; // derivative of the displacement by the share, once they crack
      since_start.restart();
      for (double share = 0.; share < 1.;)
        {
          const double    next  = share + step > 1. - 1e-9 ? 1. : share + step;
          const LoadState begin = start.grown_to(end, share),
                          goal  = start.grown_to(end, next);
          const Vector displacement_before = state.displacement;
          const auto   memory_before       = state.material_memory;
          const auto   points_before       = contact_points();
          if (rate.size() > 0 && !secants.empty())
            state.displacement.add(next - share, rate);
          increment           = {{share, next}};
          is_last             = next == 1.;
          const bool is_trial = step > largest_step;
          may_be_halved       = !is_trial && step > least_step;
          is_found            = true;
          iterations += find_equilibrium(goal, is_trial);

          const bool has_dissipated =
            is_found &&
            dissipated(state.material_memory, memory_before.losses().material);
          double error = 0.;
          if (!is_found || (has_dissipated && is_trial))
            error = 1.;
          else if (has_dissipated)
            error = error_of_return_mapping(displacement_before,
                                            memory_before,
                                            begin.grown_to(goal, 0.5),
                                            goal);
          if (error <= tolerance || (!is_trial && step <= least_step))
            {
              if (has_dissipated)
                count_losses(displacement_before, memory_before, begin, goal);
              if (!is_trial)
                {
                  rate = state.displacement;
                  rate -= displacement_before;
                  rate /= next - share;
                  if (next < 1.)
                    log.line("    ",
                             100. * next,
                             " % of the loads of the stage, the rest in about ",
                             duration_text(since_start.wall_time() *
                                           (1. - next) / next));
                }
              share = next;
              ++increments;
              n_jumps += error > tolerance;
              largest_error = std::max(largest_error, error);
              // after a sudden crack longer increments suffice again
              if (!is_trial && error < 0.25 * tolerance)
                step = std::min(2. * step, largest_step);
              continue;
            }
          if (is_trial)
            since_start.restart();
          step                  = is_trial ? largest_step : 0.5 * step;
          state.displacement    = displacement_before;
          state.material_memory = memory_before;
          if (model.contact != nullptr)
            model.contact->set_points(points_before);
        }
      if (n_jumps > 0)
        log.warn(
          "in the stage \"",
          join(stage, ", "),
          "\" ",
          counted(n_jumps, "load increment", "load increments"),
          " of ",
          100. * least_step,
          " % change the forces of the materials by up to ",
          100. * largest_error,
          " % of the loads against two of half the size, as where a crack "
          "grows suddenly; take more stages, or more \"Load increments\" in "
          "section \"Static state\"");
      return iterations;
    }


    unsigned int
    StaticStages::find_equilibrium(const LoadState &load_state,
                                   const bool       is_trial)
    {
      const Vector force  = total_force(load_state);
      auto         points = contact_points();
      for (unsigned int k = 0; k < points.size(); ++k)
        points[k].uplift = load_state.uplift[k];
      if (model.contact != nullptr)
        model.contact->set_points(points);
      unsigned int iterations = 0;
      if (!dissipated(state.material_memory))
        iterations += find_elastic_equilibrium(force);
      if (internal_force.has_memory())
        {
          internal_force.set_thermal_strain(load_state.temperature,
                                            state.material_memory);
          iterations += crack_and_yield(force, points, is_trial);
          internal_force.respond(state.force,
                                 state.displacement,
                                 state.material_memory);
        }
      if (!std::isfinite(state.displacement.l2_norm() + state.force.l2_norm()))
        throw LostEquilibrium(
          "The static stage \"" + join(stage, ", ") +
            "\" comes to no equilibrium: displacements or "
            "forces are no longer finite (NaN or infinite). "
            "Check the strength of the materials and the loads of the stage.",
          before,
          before);
      return iterations;
    }


    double
    StaticStages::error_of_return_mapping(const Vector    &before,
                                          MaterialMemory   memory,
                                          const LoadState &middle,
                                          const LoadState &end) const
    {
      Vector displacement = before;
      displacement.sadd(0.5, 0.5, state.displacement);
      Vector in_two(displacement), at_once(displacement);
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
    StaticStages::count_losses(const Vector         &before,
                               const MaterialMemory &memory,
                               const LoadState      &begin,
                               const LoadState      &end)
    {
      constexpr double       tolerance   = 0.01;
      constexpr unsigned int max_steps   = 64;
      const double           lost_before = dissipation(memory);
      double lost = dissipation(state.material_memory) - lost_before;
      Vector force(before), displacement(before);
      for (unsigned int n = 2; n <= max_steps; n *= 2)
        {
          MaterialMemory in_steps = memory;
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
    StaticStages::contact_points() const
    {
      return model.contact != nullptr ? model.contact->points() :
                                        std::vector<ContactPoint>();
    }


    unsigned int
    StaticStages::find_elastic_equilibrium(const Vector &force)
    {
      if (model.contact != nullptr)
        return search_equilibrium(force, nullptr);
      return solver->solve(state.displacement, force, parameters.tolerance);
    }


    unsigned int
    StaticStages::crack_and_yield(const Vector                    &force,
                                  const std::vector<ContactPoint> &before,
                                  const bool                       is_trial)
    {
      if (!dissipated(state.material_memory))
        {
          MaterialMemory tried = state.material_memory;
          internal_force.respond(state.force, state.displacement, tried);
          if (!dissipated(tried))
            {
              state.material_memory = std::move(tried);
              return 0;
            }
          if (is_trial)
            {
              state.material_memory = std::move(tried);
              return 0;
            }
          log.line("  cracks or yields");
          // interfaces start anew, as the load path does
          if (model.contact != nullptr)
            model.contact->set_points(before);
        }
      return search_equilibrium(force, &state.material_memory);
    }


    void
    StaticStages::relax(const Vector &force, MaterialMemory &memory)
    {
      const Relaxation::Result motion = relaxation->find_equilibrium(
        state.displacement, memory, force, parameters.rest, log);
      damped_steps += motion.steps;
      if (!motion.at_rest)
        throw LostEquilibrium(
          "The static stage \"" + join(stage, ", ") +
            "\" comes to no equilibrium: after " +
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


    unsigned int
    StaticStages::search_equilibrium(const Vector   &force,
                                     MaterialMemory *memory)
    {
      // within a stage only down to a part of the increments' own error of 1e-3
      constexpr double on_the_path = 1e-5;
      const double     of_the_last = model.contact != nullptr ?
                                       0.1 * parameters.rest :
                                       std::max(parameters.tolerance, 1e-8);
      const double     tolerance =
        is_last ? of_the_last : std::max(of_the_last, on_the_path);
      // a long crack takes several steps for each cell along it
      const unsigned int patience =
        memory != nullptr && may_be_halved ? 100 : 300;
      const EquilibriumSearch::Effort effort =
        EquilibriumSearch(*solver,
                          internal_force,
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
      text << std::setprecision(2) << "    by multigrid: " << effort.iterations
           << " iterations in " << effort.steps << " steps, ";
      if (!std::isfinite(effort.residual))
        text << "whose forces are not finite";
      else
        {
          text << "equilibrium to " << effort.residual;
          if (model.contact != nullptr)
            text << ", forces of contact to " << effort.contact.force;
        }
      is_found = effort.found || memory == nullptr || !may_be_halved;
      if (!effort.found)
        text << "; not found, so "
             << (is_found ? "by dynamic relaxation" : "in two load increments");
      log.line(text.str());
      if (!is_found)
        return effort.iterations;
      MaterialMemory none;
      if ((model.contact != nullptr && is_last) || !effort.found)
        relax(force, memory == nullptr ? none : *memory);
      by_multigrid = by_multigrid && effort.found;
      return effort.iterations;
    }


    double
    StaticStages::dissipation(const MaterialMemory &memory) const
    {
      return Utilities::MPI::sum<double>(memory.losses().material,
                                         model.solid.grid().communicator());
    }


    bool
    StaticStages::dissipated(const MaterialMemory &memory,
                             const double          before) const
    {
      return Utilities::MPI::max(memory.losses().material - before,
                                 model.solid.grid().communicator()) > 0.;
    }


    void
    StaticStages::report_progress(const double share, const std::string &text)
    {
      if (!log.progress_is_due())
        return;
      const double done = increment[0] + share * (increment[1] - increment[0]);
      std::ostringstream line;
      line << "of static stage " << number << " of "
           << parameters.stage_names().size() << ": " << text;
      // a first trial may end with the news that there is a path to follow
      if (done > 0. && !(internal_force.has_memory() && increment[0] == 0.))
        line << ", time left in it "
             << duration_text(since_start.wall_time() * (1. - done) / done);
      log.progress(done, line.str());
    }


    void
    StaticStages::report_equilibrium(const unsigned int iterations,
                                     const double       seconds,
                                     nlohmann::json    &report) const
    {
      const Tensor<1, 3> reactions = resultant(state.force);
      const double       largest   = largest_amount(state.displacement);
      std::ostringstream text;
      text << std::setprecision(4) << "  stage \"" << join(stage, ", ")
           << "\": " << iterations << " iterations, " << duration_text(seconds)
           << "; reactions " << meganewtons(reactions)
           << ", largest displacement " << 1e3 * largest << " mm";
      log.line(text.str());
      report["iterations"]      = iterations;
      report["load increments"] = increments;
      report["dissipated by materials [J]"] =
        dissipation(state.material_memory);
      report["found by multigrid"]          = by_multigrid;
      report["steps of dynamic relaxation"] = damped_steps;
      report["sum of loads so far [N]"]     = to_json(resultant(loads));
      report["sum of reactions [N]"]        = to_json(reactions);
      report["largest displacement [m]"]    = largest;
      report["names"]                       = stage;
      results.describe({model.solid.discretization,
                        materials,
                        internal_force,
                        damping,
                        state.material_memory,
                        state,
                        1.},
                       model.contact,
                       report);
      log(description_of_stage(report));
    }


    void
    add_stage(const StaticParameters::Stage &stage,
              const nlohmann::json          &report,
              nlohmann::json                &summary)
    {
      summary["stages"].push_back(report);
      if (!stage.name.empty())
        summary["combinations"][stage.name] = report;
    }


    /** The state after the last stage, in the static model. */
    InitialState
    apply_stages(const StaticModel      &model,
                 const StaticParameters &parameters,
                 const NamedLoads       &loads,
                 Log                    &log,
                 nlohmann::json         &summary)
    {
      const Timer                               clock;
      const std::map<std::string, const Load *> load_of(loads.begin(),
                                                        loads.end());
      StaticStages                              stages(model, parameters, log);
      stages.set_up();
      for (const auto &stage : parameters.stage_list())
        add_stage(stage, stages.apply(stage, load_of), summary);
      summary["seconds"] = clock.wall_time();
      return std::move(stages.state);
    }
  } // namespace


  void
  check_stage_results(const Discretization   &discretization,
                      const StaticParameters &parameters)
  {
    StageResults(discretization, parameters);
  }


  nlohmann::json
  outline_of_static_state(const StaticModel      &model,
                          const StaticParameters &parameters,
                          const NamedLoads       &loads)
  {
    const std::map<std::string, const Load *> load_of(loads.begin(),
                                                      loads.end());
    Log            unseen(model.solid.grid().communicator(), true);
    StaticStages   stages(model, parameters, unseen);
    nlohmann::json summary;
    for (const auto &stage : parameters.stage_list())
      add_stage(stage, stages.outline(stage, load_of), summary);
    return summary;
  }


  InitialState
  find_static_state(const StaticModel      &model,
                    const StaticParameters &parameters,
                    const NamedLoads       &loads,
                    Log                    &log,
                    nlohmann::json         &summary)
  {
    InitialState state = apply_stages(model, parameters, loads, log, summary);
    std::swap(state.reaction, state.force);
    if (model.contact != nullptr)
      {
        state.contact_force = model.solid.discretization.create_vector();
        model.contact->add_forces(1., state.contact_force);
      }
    return state;
  }


  double
  hand_over(InitialState        &state,
            const InternalForce &internal_force,
            const NodalTerms    &terms)
  {
    if (state.displacement.size() == 0)
      return 0.;
    internal_force.hand_over(state.material_memory);
    internal_force.set_static_state(state.displacement,
                                    state.temperature,
                                    state.material_memory);
    state.force.reinit(state.displacement);
    state.material_memory.set_losses({});
    internal_force.respond(state.force,
                           state.displacement,
                           state.material_memory);
    const double loss = state.material_memory.losses().material;
    state.material_memory.set_losses({});
    terms.add_to(state.force, state.displacement, 0.);
    if (state.contact_force.size() > 0)
      state.force -= state.contact_force;
    return loss;
  }
} // namespace Voussoir
