#include <voussoir/analysis/load_path.h>
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
      add_loads(const std::vector<std::string>            &names,
                const std::map<std::string, const Load *> &load_of,
                nlohmann::json                            &report);

      /** All loads so far. */
      StaticLoads
      static_loads() const;

      void
      report_equilibrium(const StaticParameters::Stage &applied,
                         const LoadPath::Effort        &effort,
                         const double                   seconds,
                         nlohmann::json                &report) const;

      const StaticModel &model;
      Log               &log;
      LoadPath           path;
      const StageResults results;
      Vector             loads; // so far [N]
    };


    StaticStages::StaticStages(const StaticModel      &model,
                               const StaticParameters &parameters,
                               Log                    &log)
      : model(model)
      , log(log)
      , path(model, parameters, state, log)
      , results(model.solid.discretization, parameters)
      , loads(model.solid.discretization.create_vector())
    {
      state.temperature = loads;
    }


    void
    StaticStages::set_up()
    {
      path.set_up();
    }


    nlohmann::json
    StaticStages::apply(const StaticParameters::Stage             &applied,
                        const std::map<std::string, const Load *> &load_of)
    {
      const Timer    clock;
      nlohmann::json report;
      path.begin_stage(applied.loads);
      const StaticLoads start = static_loads();
      add_loads(applied.loads, load_of, report);
      if (model.contact != nullptr)
        model.contact->apply_uplift(applied.loads);
      const LoadPath::Effort effort = path.follow(start, static_loads());
      report_equilibrium(applied, effort, clock.wall_time(), report);
      report["name"] = applied.title();
      state.stages.emplace_back(applied.title(), state.displacement);
      if (model.contact != nullptr &&
          model.contact->grout(applied.loads, state.displacement))
        {
          state.grouted_displacement = state.displacement;
          path.ties_have_changed();
        }
      return report;
    }


    nlohmann::json
    StaticStages::outline(const StaticParameters::Stage             &applied,
                          const std::map<std::string, const Load *> &load_of)
    {
      nlohmann::json report;
      add_loads(applied.loads, load_of, report);
      report_equilibrium(applied, {}, 0., report);
      return report;
    }


    void
    StaticStages::add_loads(const std::vector<std::string>            &names,
                            const std::map<std::string, const Load *> &load_of,
                            nlohmann::json                            &report)
    {
      for (const std::string &name : names)
        {
          const Load  &load = *load_of.at(name);
          const Vector force =
            force_of(load, model.solid.discretization, model.terms);
          load.add_temperature(state.temperature);
          nlohmann::json    &of_load = report["loads"][name];
          const Tensor<1, 3> sum     = resultant(force);
          of_load["resultant [N]"]   = to_json(sum);
          const auto  by_geometry    = load.resultant_of_geometry();
          std::string beside;
          if (by_geometry)
            {
              beside = ", by volumes and areas " + meganewtons(*by_geometry);
              of_load["resultant by volumes and areas [N]"] =
                to_json(*by_geometry);
            }
          log.line("  load ", name, ": resultant ", meganewtons(sum), beside);
          loads += force;
        }
    }


    StaticLoads
    StaticStages::static_loads() const
    {
      StaticLoads result{loads, state.temperature, {}};
      if (model.contact != nullptr)
        for (const ContactPoint &point : model.contact->points())
          result.uplift.push_back(point.uplift);
      return result;
    }


    void
    StaticStages::report_equilibrium(const StaticParameters::Stage &applied,
                                     const LoadPath::Effort        &effort,
                                     const double                   seconds,
                                     nlohmann::json &report) const
    {
      const Tensor<1, 3> reactions = resultant(state.force);
      const double       largest   = largest_amount(state.displacement);
      std::ostringstream text;
      text << std::setprecision(4) << "  stage \"" << applied.title()
           << "\": " << effort.iterations << " iterations, "
           << duration_text(seconds) << "; reactions " << meganewtons(reactions)
           << ", largest displacement " << 1e3 * largest << " mm";
      log.line(text.str());
      report["iterations"]                  = effort.iterations;
      report["load increments"]             = effort.increments;
      report["dissipated by materials [J]"] = path.dissipation();
      report["found by multigrid"]          = effort.by_multigrid;
      report["steps of dynamic relaxation"] = effort.damped_steps;
      report["sum of loads so far [N]"]     = to_json(resultant(loads));
      report["sum of reactions [N]"]        = to_json(reactions);
      report["largest displacement [m]"]    = largest;
      report["names"]                       = applied.loads;
      results.describe(path.stress_model(), model.contact, report);
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
