#include <voussoir/base/interruption.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/first_files.h>
#include <voussoir/driver/run.h>
#include <voussoir/driver/verdict_tables.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    std::vector<ActingLoad>
    acting_loads(const Model &model)
    {
      std::vector<ActingLoad> list;
      for (const Load *load : model.running_loads())
        list.emplace_back(*load);
      return list;
    }


    void
    refuse_missing_files(const std::map<std::string, std::string> &missing)
    {
      if (missing.empty())
        return;
      const auto &[name, reason] = *missing.begin();
      throw UserError(
        "Done, but \"" + name + "\" " +
        (missing.size() > 1 ?
           "and " + counted(missing.size() - 1, "other file", "other files") +
             " (see the warnings) " :
           "") +
        "could not be written because " + reason +
        "; remove the cause and run the case again.");
    }
  } // namespace


  Run::Run(const Model        &model,
           const StaticState  &static_state,
           const Modes        &modes,
           const ResultFolder &folder,
           Log                &log)
    : Run(static_state,
          modes,
          folder,
          std::make_unique<RunSetup>(RunPlan(model, log), modes, folder, log),
          log)
  {}


  Run::Run(const StaticState        &static_state,
           const Modes              &modes,
           const ResultFolder       &folder,
           std::unique_ptr<RunSetup> made,
           Log                      &log)
    : setup(std::move(made))
    , model(setup->model)
    , static_state(static_state)
    , modes(modes)
    , folder(folder)
    , log(log)
    , damping(setup->damping)
    , time_step(setup->time_step)
    , contact(static_state.contact)
    , loads(acting_loads(model))
    , crack_tips(model.solid.discretization,
                 {model.solid.materials.begin(), model.solid.materials.end()})
    , crack_planes(model.solid.discretization,
                   {model.solid.materials.begin(), model.solid.materials.end()},
                   setup->internal_force,
                   damping)
    , equation{model.solid.discretization,
               setup->internal_force,
               model.solid.mass,
               model.terms,
               damping,
               static_state.initial,
               nodal_loads(),
               projections(),
               setup->earthquake.base.moves() ? &setup->earthquake.base :
                                                nullptr,
               time_step.closing_viscosity,
               &crack_tips,
               &crack_planes}
    , scheme(equation, time_step.leap_frog())
    , state(scheme.initial_state())
    , observed{setup->plan.observed(log),
               setup->internal_force,
               damping,
               state.material_memory,
               static_state.initial,
               setup->water.get(),
               contact ? &*contact : nullptr,
               setup->earthquake.base,
               scheme,
               folder.path(),
               time_step.length,
               folder.start_time(),
               folder.restarts()}
    , energy(equation,
             time_step.length,
             model.parameters.output.energy_interval)
    , times(model.solid.discretization.dof_handler.n_dofs())
    , supervision(observed,
                  energy,
                  model.parameters.output.energy_limit,
                  lowered_strength(model))
    , checkpoints(*setup, folder, contact ? &*contact : nullptr, log)
    , requests(model.parameters.output, folder, log)
  {
    if (folder.exists())
      open_output();
    if (contact)
      contact->begin_earthquake();
    const bool resumes = folder.exists() && folder.restarts();
    if (resumes)
      checkpoints.read(state, energy);
    for (Projection *projection : equation.projections)
      projection->start(state);
    if (resumes && contact)
      contact->resume();
    // at a restart the table has this line already
    if (!folder.restarts() || energy.is_due(state.step))
      energy.evaluate(state);
    supervision.keep(state);
  }


  std::vector<NodalLoad *>
  Run::nodal_loads()
  {
    std::vector<NodalLoad *> list;
    if (setup->earthquake.wave)
      list.push_back(setup->earthquake.wave.get());
    for (ActingLoad &load : loads)
      list.push_back(&load);
    if (setup->water)
      list.push_back(setup->water.get());
    return list;
  }


  std::vector<Projection *>
  Run::projections()
  {
    std::vector<Projection *> list;
    for (const auto &constraint : setup->plan.constraints)
      list.push_back(constraint.second.get());
    if (contact)
      list.push_back(&*contact);
    return list;
  }


  unsigned long long
  Run::n_steps() const
  {
    return time_step.steps_to(model.parameters.time.end_time);
  }


  void
  Run::open_output()
  {
    write_static_stages(static_state.summary, folder.path(), log);
    write_modes(modes, observed);
    write_ground_motion(setup->plan.motion, folder.path(), log);
    energy.open(folder.path(), folder.start_time(), folder.restarts(), log);
    for (const auto &observer : setup->plan.observers)
      observer.second->begin(observed);
  }


  RunSummary
  Run::march()
  {
    begin();
    while (state.step < n_steps())
      step();
    return end();
  }


  void
  Run::begin()
  {
    times.start(state.step);
    requests.start(state.step);
    if (folder.exists() && model.parameters.output.has_checkpoints() &&
        !folder.restarts())
      write_checkpoint();
    if (state.step < n_steps() && !model.parameters.moves())
      log.warn(
        "nothing moves the model, neither an earthquake nor a constraint nor "
        "a load outside the static stages, so that it stays at rest; give one "
        "of these, or \"End time = 0\" in section \"Time\"");
    observe(); // after a restart the state of the checkpoint once more
  }


  void
  Run::step()
  {
    const bool at_end   = state.step + 1 == n_steps();
    const bool balances = energy.is_due(state.step + 1) || at_end;
    if (balances)
      energy.before_step(state);
    {
      TimerOutput::Scope scope(times.sections, "step");
      scheme.step(state);
    }
    observe();
    if (balances)
      {
        TimerOutput::Scope scope(times.sections, "energy balance");
        energy.evaluate(state, at_end);
        if (const std::string reason = supervision.check_energy(state);
            !reason.empty())
          abort(reason);
      }
    supervision.check_motion(state, at_end);
    if (folder.exists() && checkpoints.are_due(state.step))
      write_checkpoint();
    if (requests.are_due(state.step))
      poll_requests();
  }


  RunSummary
  Run::end()
  {
    times.stop();
    supervision.check_contact();
    RunSummary summary = summary_of(*this);
    if (folder.exists())
      {
        TimerOutput::Scope scope(times.sections, "output");
        for (const auto &observer : setup->plan.observers)
          observer.second->finish(state, summary.observers);
        log.write_growing_files();
        log.check_for_lost_files();
      }
    summary.checks = numerical_checks(*this);
    summary.judge(model.parameters.acceptance);
    if (folder.exists())
      write_summary(folder.path(), summary, log);
    log(conclusion(*this, summary));
    log(times.table());
    refuse_missing_files(log.missing_files());
    return summary;
  }


  void
  Run::observe()
  {
    if (!folder.exists())
      return;
    TimerOutput::Scope scope(times.sections, "output");
    for (const auto &observer : setup->plan.observers)
      observer.second->observe(state);
  }


  bool
  Run::write_checkpoint()
  {
    TimerOutput::Scope scope(times.sections, "checkpoint");
    requests.checkpoint_tried();
    return checkpoints.write(state, energy);
  }


  void
  Run::poll_requests()
  {
    const RunRequests::Requests asked = requests.poll(state.step);
    std::ostringstream          text;
    if (asked.report)
      {
        text << std::fixed << std::setprecision(3) << "t = " << state.time
             << " s  " << times.time_left(state.step, n_steps())
             << "  energy-balance error " << 100. * energy.relative_error()
             << " %  " << std::setprecision(1) << times.throughput(state.step)
             << " MDOF-steps/s";
        log.progress(double(state.step) / double(n_steps()), text.str());
      }
    const bool saved =
      folder.exists() && (asked.stop || asked.save) && write_checkpoint();
    if (asked.stop)
      {
        std::ostringstream text;
        text << "Stopped on request at t = " << state.time << " s"
             << (saved ? "; \"--restart\" continues from here." :
                         ", without a checkpoint of this time.");
        stop(text.str());
      }
  }


  void
  Run::abort(const std::string &reason)
  {
    supervision.check_contact();
    RunSummary summary = summary_of(*this);
    summary.end        = RunEnd::stopped;
    summary.reason     = reason;
    summary.checks     = numerical_checks(*this);
    summary.judge(model.parameters.acceptance);
    std::string written;
    if (folder.exists())
      {
        const std::string picture = supervision.draw_last_good();
        if (!picture.empty())
          written =
            "; the last good state is in " + folder.path() + "/" + picture;
        write_summary(folder.path(), summary, log);
      }
    std::ostringstream text;
    text << "Stopped at t = " << state.time << " s, because " << reason
         << written
         << ". The time step may be too large for the model: take a smaller "
            "\"Safety factor\" in section \"Time\".";
    throw StoppedRun(text.str(), summary);
  }
} // namespace Voussoir
