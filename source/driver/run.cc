#include <voussoir/base/error.h>
#include <voussoir/driver/run.h>
#include <voussoir/output/field_writer.h>

#include <csignal>
#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // set by SIGINT and SIGTERM: finish the step, write a checkpoint, stop
    volatile std::sig_atomic_t stop_requested = 0;

    void
    request_stop(int)
    {
      stop_requested = 1;
    }


    Damping
    adapted_damping(const DampingParameters &parameters, const Modes &modes)
    {
      Damping damping(parameters);
      damping.adapt_to_modes(modes.frequencies());
      return damping;
    }


    std::optional<double>
    kept_step(const ResultFolder &folder)
    {
      if (!folder.restarts())
        return {};
      return folder.checkpoint().at("time step").get<double>();
    }


    /** The shortest of all records [s]; 0 if nothing is recorded. */
    double
    record_interval(const Model &model, const ResultFolder &folder)
    {
      double shortest = 0.;
      if (folder.exists())
        for (const auto &observer : model.parameters.observers)
          {
            const double interval = observer.second->record_interval();
            if (interval > 0. && (shortest == 0. || interval < shortest))
              shortest = interval;
          }
      return shortest;
    }


    std::unique_ptr<WaterMotion>
    make_water(const Model      &model,
               const Earthquake &earthquake,
               const TimeStep   &time_step)
    {
      if (!model.reservoir)
        return nullptr;
      return std::make_unique<WaterMotion>(*model.reservoir,
                                           earthquake.base,
                                           time_step.length);
    }
  } // namespace


  Run::Run(const Model        &model,
           const RestState    &rest,
           const Modes        &modes,
           const ResultFolder &folder,
           Log                &log)
    : model(model)
    , rest(rest)
    , modes(modes)
    , folder(folder)
    , log(log)
    , damping(adapted_damping(model.parameters.damping, modes))
    , time_step(model,
                damping,
                kept_step(folder),
                record_interval(model, folder),
                log)
    , earthquake(model, damping, time_step, log)
    , water(make_water(model, earthquake, time_step))
    , contact(rest.contact)
    , equation{model.discretization,
               model.internal_force,
               model.mass,
               model.terms,
               damping,
               rest.initial,
               nodal_loads(),
               projections(),
               earthquake.base.moves() ? &earthquake.base : nullptr,
               time_step.closing_viscosity}
    , scheme(equation, time_step.leap_frog())
    , state(scheme.state_at_rest())
    , observed(what_is_observed())
    , energy(equation, time_step.length)
    , checkpoint(model.discretization, folder.path() + "/checkpoint")
    , timer(std::cout, TimerOutput::never, TimerOutput::wall_times)
  {
    for (const auto &observer : model.parameters.observers)
      observer.second->check(observed);
    // a case that is refused up to here leaves nothing behind
    if (folder.exists())
      open_output();
    if (folder.restarts())
      read_checkpoint();
    for (Projection *projection : equation.projections)
      projection->start(state);
    energy.evaluate(state);
    keep_last_good();
  }


  std::vector<NodalLoad *>
  Run::nodal_loads() const
  {
    std::vector<NodalLoad *> list;
    if (earthquake.wave)
      list.push_back(earthquake.wave.get());
    list.insert(list.end(),
                model.running_loads.begin(),
                model.running_loads.end());
    if (water)
      list.push_back(water.get());
    return list;
  }


  std::vector<Projection *>
  Run::projections()
  {
    std::vector<Projection *> list = model.constraints;
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
  Run::march()
  {
    stop_requested = 0;
    std::signal(SIGINT, request_stop);
    std::signal(SIGTERM, request_stop);
    const Schedule energy_schedule(model.parameters.output.energy_interval,
                                   time_step.length);
    first_step = state.step;
    clock.restart();
    since_report.restart();
    since_checkpoint.restart();
    observe(); // after a restart what they saw last, once more

    while (state.step < n_steps())
      {
        {
          TimerOutput::Scope scope(timer, "step");
          scheme.step(state);
        }
        observe();
        if (energy_schedule.due(state.step) || state.step == n_steps())
          {
            check_energy();
            keep_last_good();
            attend();
          }
      }
    finish();
  }


  void
  Run::observe()
  {
    if (!folder.exists())
      return;
    TimerOutput::Scope scope(timer, "output");
    for (const auto &observer : model.parameters.observers)
      observer.second->observe(state);
  }


  void
  Run::check_energy()
  {
    TimerOutput::Scope scope(timer, "energy balance");
    energy.evaluate(state);
    if (const std::string reason =
          energy.alarm(model.parameters.output.energy_limit);
        !reason.empty())
      abort(reason);
    const double error =
      std::max(energy.relative_error(), energy.error_of_losses());
    if (error > 0.01 && warnings.empty())
      {
        std::ostringstream text;
        text << std::setprecision(3) << "from t = " << state.time
             << " s on more than 1 % of the energy comes from nowhere: "
             << 100. * energy.relative_error() << " % of what came in, "
             << 100. * energy.error_of_losses()
             << " % of what damping, cracks, friction and impacts took";
        warnings.push_back(text.str());
        log.line("Warning: ", text.str());
      }
  }


  void
  Run::check_contact()
  {
    if (!contact)
      return;
    const ContactSolver::Effort effort = contact->effort();
    if (effort.unsolved == 0)
      return;
    std::ostringstream text;
    text << std::setprecision(3) << "the contact of " << effort.unsolved
         << " clusters of nodes was not solved: gaps miss the laws of their "
            "interfaces by up to "
         << 100. * effort.residual
         << " % of the motion in a step; compare with a run with a smaller "
            "\"Safety factor\" in section \"Time\"";
    warnings.push_back(text.str());
  }


  void
  Run::keep_last_good()
  {
    last_good.displacement = state.displacement;
    last_good.velocity     = state.velocity;
    last_good.time         = state.time;
  }


  void
  Run::attend()
  {
    // all ranks go by the clock of the first
    const double checkpoint_interval =
      60. * model.parameters.output.checkpoint_interval;
    std::array<int, 3> due{
      {since_report.wall_time() > 5. ? 1 : 0,
       checkpoint_interval > 0. &&
           since_checkpoint.wall_time() > checkpoint_interval ?
         1 :
         0,
       stop_requested != 0 ? 1 : 0}};
    due = Utilities::MPI::broadcast(log.communicator(), due);
    if (due[0])
      {
        report_progress();
        since_report.restart();
      }
    if (folder.exists() && (due[1] || due[2]))
      write_checkpoint();
    if (due[2])
      throw UserError("Stopped on request at " + std::to_string(state.time) +
                      " s; \"--restart\" goes on from here.");
  }


  void
  Run::abort(const std::string &reason)
  {
    std::string written;
    check_contact();
    if (folder.exists())
      {
        write_fields(observed,
                     {{&last_good.displacement, {"displacement"}},
                      {&last_good.velocity, {"velocity"}}},
                     &last_good.displacement,
                     "last_good",
                     last_good.time);
        written =
          "; the last good state is in " + folder.path() + "/last_good.vtu";
        nlohmann::json result = summary();
        result["verdict"]     = "stopped: " + reason;
        write_summary(result);
      }
    std::ostringstream text;
    text << "Stopped at t = " << state.time << " s, because " << reason
         << written
         << ". The time step may be too large for the model: take a smaller "
            "\"Safety factor\" in section \"Time\".";
    throw UserError(text.str());
  }
} // namespace Voussoir
