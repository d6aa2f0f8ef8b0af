#include <voussoir/analysis/elastic_solver.h>
#include <voussoir/analysis/relaxation.h>
#include <voussoir/analysis/static_state.h>
#include <voussoir/fem/nodal_values.h>

#include <deal.II/base/timer.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  void
  StaticParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Stages",
      stages,
      "Loads that are there before the earthquake: stages separated by "
      "semicolons, in their order, with the names of loads separated by "
      "commas, as in \"weight; water, silt; temperature\". They stay as they "
      "are at t = 0. Empty: no static stage.");
    prm.add_parameter(
      "Supports",
      supports,
      "How the absorbing faces stand in the static stage: fixed, held at right "
      "angles to themselves (roller), or on the springs of the boundary. Their "
      "reactions stay when the faces begin to absorb.",
      Patterns::Selection("fixed|roller|springs"));
    prm.add_parameter("Relative tolerance",
                      tolerance,
                      "Residual of the static equations over the load.",
                      Patterns::Double(1e-14, 1e-2));
    prm.add_parameter("Rest tolerance",
                      rest,
                      "With interfaces: motion in a natural period over the "
                      "largest displacement at which the state is at rest.",
                      Patterns::Double(1e-12, 1e-2));
  }


  std::vector<std::vector<std::string>>
  StaticParameters::stage_names() const
  {
    std::vector<std::vector<std::string>> names;
    for (const std::string &stage : split_list(stages, ';'))
      names.push_back(split_list(stage));
    return names;
  }


  void
  StaticParameters::check(const NamedLoads           &loads,
                          const InterfacesParameters &interfaces) const
  {
    std::vector<std::string> known;
    for (const auto &load : loads)
      known.push_back(load.first);
    std::set<std::string> staged;
    for (const auto &stage : stage_names())
      for (const std::string &name : stage)
        {
          if (std::find(known.begin(), known.end(), name) == known.end())
            throw UserError("\"Stages\" in section \"Static state\" names \"" +
                            name +
                            "\", which is not among the \"Names\" of "
                            "section \"Loads\"" +
                            known_names(name, known) + ".");
          if (!staged.insert(name).second)
            throw UserError("\"Stages\" in section \"Static state\" names \"" +
                            name + "\" twice; keep one of them.");
        }
    for (const auto &[name, load] : loads)
      if (load->steady() && staged.count(name) == 0)
        throw UserError("The load \"" + name +
                        "\" is there before the earthquake, but \"Stages\" in "
                        "section \"Static state\" does not name it; add it "
                        "there.");
    for (const InterfaceParameters &interface : interfaces.list)
      {
        const std::string &after = interface.grouted_after;
        const std::string  place = "section \"Interfaces/" + interface.name;
        if (after.empty())
          continue;
        if (staged.count(after) == 0)
          throw UserError(
            "\"Grouted after\" in " + place + "\" names \"" + after +
            "\", which is not in the \"Stages\" of section \"Static state\"" +
            known_names(after, {staged.begin(), staged.end()}) + ".");
        const auto last = stage_names().back();
        if (interface.uplift.given() &&
            std::find(last.begin(), last.end(), after) != last.end())
          throw UserError("The interface of " + place +
                          "\" is grouted after the last of the static stages, "
                          "so that its \"Uplift\" would come with the "
                          "earthquake; let a stage follow.");
      }
  }


  namespace
  {
    std::string
    meganewtons(const Tensor<1, 3> &force)
    {
      std::ostringstream text;
      text << std::setprecision(5) << "(" << 1e-6 * force[0] << ", "
           << 1e-6 * force[1] << ", " << 1e-6 * force[2] << ") MN";
      return text.str();
    }


    nlohmann::json
    to_json(const Tensor<1, 3> &force)
    {
      return {force[0], force[1], force[2]};
    }


    // What a load does before the earthquake, on held nodes too.
    Vector
    force_of(const Load           &load,
             const Discretization &discretization,
             NodalTerms           &terms)
    {
      Vector force = discretization.create_vector();
      std::fill(terms.forces.begin(), terms.forces.end(), Tensor<1, 3>());
      load.add_forces(0., terms);
      for (unsigned int slot = 0; slot < terms.nodes.size(); ++slot)
        for (unsigned int d = 0; d < 3; ++d)
          force.local_element(3 * terms.nodes[slot] + d) =
            terms.forces[slot][d];
      load.add_steady_force(force);
      return force;
    }


    /**
     * Equilibrium with cracks and plastic flow by the method of initial
     * stresses (Zienkiewicz et al. 1969), u += K^-1 (F - f(u)) with the elastic
     * K. It comes from the side of too little displacement, while damped motion
     * overshoots and so brings more flow than slowly growing loads would.
     *
     * @param springs of the absorbing boundary, or null if it is held
     * @return whether the residual is below the tolerance times the force; it
     *   may not be close to collapse, or where cracks run
     */
    bool
    correct_by_initial_stresses(const ElasticSolver &solver,
                                const InternalForce &internal_force,
                                MaterialMemory      &memory,
                                const NodalTerms    *springs,
                                Vector              &displacement,
                                const Vector        &force,
                                const double         tolerance,
                                unsigned int        &iterations)
    {
      constexpr unsigned int max_corrections = 200;
      Vector                 goal = force, residual = force, change = force;
      solver.clear_held(goal);
      for (unsigned int i = 0; i < max_corrections; ++i)
        {
          internal_force.respond(residual, displacement, memory);
          if (springs != nullptr)
            springs->add_to(residual, displacement, 0.);
          residual.sadd(-1., 1., force);
          solver.clear_held(residual);
          if (residual.l2_norm() <= tolerance * goal.l2_norm())
            return true;
          change = 0.;
          iterations += solver.solve(change, residual, 0.01);
          displacement += change;
        }
      return false;
    }


    /** The state after the last stage; its force is not yet that of the dynamic
     *  model. */
    InitialState
    apply_stages(const StaticModel      &model,
                 const StaticParameters &parameters,
                 const NamedLoads       &loads,
                 Log                    &log,
                 nlohmann::json         &summary)
    {
      const Discretization               &discretization = model.discretization;
      const std::map<std::string, Load *> load_of(loads.begin(), loads.end());
      const InternalForce internal_force = model.internal_force.with(
        for_each_material(model.materials, [](const Material &material) {
          return StiffnessFactors{material.static_factor,
                                  material.static_factor,
                                  0.};
        }));
      const Timer                     clock;
      const bool springs = parameters.supports == "springs";
      const AffineConstraints<double> constraints =
        discretization.make_constraints(
          springs ? model.boundaries.supports.list() :
                    model.boundaries.supports_with_absorbing(
                      parameters.supports == "roller"));
      std::unique_ptr<ElasticSolver> solver;
      std::unique_ptr<Relaxation>    relaxation;
      const bool                     has_memory = internal_force.has_memory();
      if (model.contact == nullptr)
        solver =
          std::make_unique<ElasticSolver>(discretization,
                                          internal_force,
                                          model.materials,
                                          model.material_of_cell,
                                          constraints,
                                          springs ? &model.terms : nullptr);
      if (model.contact != nullptr || has_memory)
        relaxation = std::make_unique<Relaxation>(discretization,
                                                  internal_force,
                                                  model.mass,
                                                  model.terms,
                                                  constraints,
                                                  springs,
                                                  model.contact);
      log.line("Static state by ",
               solver ? "multigrid" : "damped motion with contact",
               ", set up in ",
               duration_text(clock.wall_time()));

      InitialState state;
      state.displacement    = discretization.create_vector();
      state.temperature     = state.displacement;
      state.force           = state.displacement;
      Vector applied        = state.displacement; // loads so far
      state.material_memory = internal_force.new_memory();
      for (const auto &stage : parameters.stage_names())
        {
          const Timer    stage_clock;
          nlohmann::json report;
          for (const std::string &name : stage)
            {
              const Vector force =
                force_of(*load_of.at(name), discretization, model.terms);
              load_of.at(name)->add_temperature(state.temperature);
              const Tensor<1, 3> sum = resultant(force);
              log.line("  load ", name, ": resultant ", meganewtons(sum));
              report["loads"][name]["resultant [N]"] = to_json(sum);
              applied += force;
            }
          Vector right_side = applied;
          internal_force.add_thermal_force(right_side, state.temperature);
          // a state with cracks goes on from where it is
          unsigned int   iterations = 0;
          MaterialMemory elastic; // none
          const bool     elastic_so_far =
            Utilities::MPI::max(state.material_memory.dissipated(),
                                discretization.grid.communicator()) == 0.;
          if (!solver)
            iterations = relaxation->find_equilibrium(
              state.displacement, elastic, right_side, parameters.rest, log);
          else if (elastic_so_far)
            iterations = solver->solve(state.displacement,
                                       right_side,
                                       parameters.tolerance);
          if (has_memory)
            {
              internal_force.set_static_state(state.displacement,
                                              state.temperature,
                                              state.material_memory);
              internal_force.respond(state.force,
                                     state.displacement,
                                     state.material_memory);
              if (Utilities::MPI::max(state.material_memory.dissipated(),
                                      discretization.grid.communicator()) > 0.)
                {
                  log.line("  cracks or yields");
                  if (!solver || !correct_by_initial_stresses(
                                   *solver,
                                   internal_force,
                                   state.material_memory,
                                   springs ? &model.terms : nullptr,
                                   state.displacement,
                                   right_side,
                                   std::max(parameters.tolerance, 1e-8),
                                   iterations))
                    log.line("  by damped motion at rest again after ",
                             relaxation->find_equilibrium(state.displacement,
                                                          state.material_memory,
                                                          right_side,
                                                          parameters.rest,
                                                          log),
                             " steps");
                }
            }

          // f(u) minus loads and contact is what the supports bring
          internal_force.respond(state.force,
                                 state.displacement,
                                 state.material_memory);
          state.force -= right_side;
          if (model.contact != nullptr)
            model.contact->add_forces(-1., state.force);
          const Tensor<1, 3> sum       = resultant(applied);
          const Tensor<1, 3> reactions = resultant(state.force);
          const double       largest   = largest_amount(state.displacement);
          std::ostringstream text;
          text << std::setprecision(4) << "  stage \"" << join(stage, ", ")
               << "\": " << iterations
               << (solver ? " iterations, " : " steps, ")
               << duration_text(stage_clock.wall_time()) << "; reactions "
               << meganewtons(reactions) << ", largest displacement "
               << 1e3 * largest << " mm";
          log.line(text.str());
          report["iterations"]               = iterations;
          report["sum of loads so far [N]"]  = to_json(sum);
          report["sum of reactions [N]"]     = to_json(reactions);
          report["largest displacement [m]"] = largest;
          report["names"]                    = stage;
          summary["stages"].push_back(report);
          if (model.contact != nullptr)
            model.contact->grout(stage, state.displacement);
        }
      summary["seconds"] = clock.wall_time();
      return state;
    }
  } // namespace


  InitialState
  find_static_state(const StaticModel      &model,
                    const StaticParameters &parameters,
                    const NamedLoads       &loads,
                    Log                    &log,
                    nlohmann::json         &summary)
  {
    InitialState state = apply_stages(model, parameters, loads, log, summary);

    // the same state in the dynamic model
    model.internal_force.set_static_state(state.displacement,
                                          state.temperature,
                                          state.material_memory);
    model.internal_force.respond(state.force,
                                 state.displacement,
                                 state.material_memory);
    state.material_memory.set_dissipated(0.);
    model.terms.add_to(state.force, state.displacement, 0.);
    if (model.contact != nullptr)
      {
        state.contact_force = model.discretization.create_vector();
        model.contact->add_forces(1., state.contact_force);
        state.force -= state.contact_force;
      }
    return state;
  }
} // namespace Voussoir
