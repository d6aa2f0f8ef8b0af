#include <voussoir/base/error.h>
#include <voussoir/base/interruption.h>
#include <voussoir/driver/run.h>
#include <voussoir/driver/summary_file.h>
#include <voussoir/output/field_writer.h>
#include <voussoir/output/material_memory.h>

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <tuple>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Between two looks at the clock and at what is asked from outside [s]:
    // those who ask may kill a second later. And in steps, as short runs of
    // small models take less.
    constexpr double look_interval = 0.01, look_steps = 100.;

    // Between two looks at cracks and slips [s], and how wide one may be over
    // its cell: at a fiftieth, what it cuts off is a block of its own.
    constexpr double check_interval = 0.1, widest_share = 0.02;


    std::vector<ActingLoad>
    acting_loads(const Model &model)
    {
      std::vector<ActingLoad> list;
      for (const Load *load : model.running_loads())
        list.emplace_back(*load);
      return list;
    }
  } // namespace


  Run::Run(const Model        &model,
           const RestState    &rest,
           const Modes        &modes,
           const ResultFolder &folder,
           Log                &log)
    : Run(rest,
          modes,
          folder,
          std::make_unique<RunSetup>(model, modes, folder, log),
          log)
  {}


  Run::Run(const RestState          &rest,
           const Modes              &modes,
           const ResultFolder       &folder,
           std::unique_ptr<RunSetup> made,
           Log                      &log)
    : setup(std::move(made))
    , model(setup->model)
    , rest(rest)
    , modes(modes)
    , folder(folder)
    , log(log)
    , damping(setup->damping)
    , time_step(setup->time_step)
    , earthquake(setup->earthquake)
    , water(setup->water)
    , contact(rest.contact)
    , loads(acting_loads(model))
    , equation{model.solid.discretization,
               setup->internal_force,
               model.solid.mass,
               model.terms,
               damping,
               rest.initial,
               nodal_loads(),
               projections(),
               earthquake.base.moves() ? &earthquake.base : nullptr,
               time_step.closing_viscosity}
    , scheme(equation, time_step.leap_frog())
    , state(scheme.state_at_rest())
    , observed(setup->observed(folder.path(),
                               rest.initial,
                               state.material_memory,
                               contact ? &*contact : nullptr,
                               log,
                               &scheme))
    , energy(equation,
             time_step.length,
             model.parameters.output.energy_interval)
    , checkpoint(folder.checkpoints(), log.communicator())
    , timer(std::cout, TimerOutput::never, TimerOutput::wall_times)
  {
    if (folder.exists())
      open_output();
    const bool resumes = folder.exists() && folder.restarts();
    if (resumes)
      read_checkpoint();
    for (Projection *projection : equation.projections)
      projection->start(state);
    if (resumes && contact)
      contact->resume();
    // the table has its line of a checkpoint between two
    if (!folder.restarts() || energy.is_due(state.step))
      energy.evaluate(state);
    keep_last_good();
  }


  std::vector<NodalLoad *>
  Run::nodal_loads()
  {
    std::vector<NodalLoad *> list;
    if (earthquake.wave)
      list.push_back(earthquake.wave.get());
    for (ActingLoad &load : loads)
      list.push_back(&load);
    if (water)
      list.push_back(water.get());
    return list;
  }


  std::vector<Projection *>
  Run::projections()
  {
    std::vector<Projection *> list;
    for (const auto &constraint : setup->constraints)
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
  Run::march()
  {
    begin();
    while (state.step < n_steps())
      step();
    end();
  }


  void
  Run::begin()
  {
    const OutputParameters &output = model.parameters.output;
    checkpoints  = Schedule(output.checkpoint_time, time_step.length);
    loose_checks = Schedule(check_interval, time_step.length);
    first_step = last_look = next_look = state.step;
    clock.restart();
    since_checkpoint.restart();
    since_look.restart();
    if (folder.exists() && output.has_checkpoints() && !folder.restarts())
      write_checkpoint();
    if (state.step < n_steps() && !model.parameters.moves())
      log.warn(
        "nothing moves the model, neither an earthquake nor a constraint "
        "nor a load outside the static stages: its time steps show it "
        "at rest; give one of these, or \"End time = 0\" in section "
        "\"Time\"");
    observe(); // after a restart what they saw last, once more
  }


  void
  Run::step()
  {
    const unsigned long long next = state.step + 1;
    const bool balances           = energy.is_due(next) || next == n_steps();
    if (balances)
      energy.before_step(state);
    {
      TimerOutput::Scope scope(timer, "step");
      scheme.step(state);
    }
    observe();
    if (balances)
      {
        check_energy();
        keep_last_good();
      }
    if (loose_checks.due(state.step) || state.step == n_steps())
      {
        check_cracks();
        check_slips();
      }
    if (folder.exists() && model.parameters.output.checkpoint_time > 0. &&
        checkpoints.due(state.step))
      write_checkpoint();
    if (state.step >= next_look)
      attend();
  }


  void
  Run::end()
  {
    finish();
    refuse_missing_files();
  }


  void
  Run::observe()
  {
    if (!folder.exists())
      return;
    TimerOutput::Scope scope(timer, "output");
    for (const auto &observer : setup->observers)
      observer.second->observe(state);
  }


  void
  Run::check_energy()
  {
    TimerOutput::Scope scope(timer, "energy balance");
    energy.evaluate(state, state.step == n_steps());
    if (const std::string reason =
          energy.alarm(model.parameters.output.energy_limit);
        !reason.empty())
      abort(reason);
    // what damping takes between two evaluations is known to a per cent or two
    const bool is_large =
      energy.relative_error() > 0.01 || energy.error_of_losses() > 0.03;
    if (is_large && !warned_of_energy)
      {
        std::ostringstream text;
        text << std::setprecision(3) << "from t = " << state.time
             << " s on the energy-balance error is large: "
             << 100. * energy.relative_error() << " % of what came in, "
             << 100. * energy.error_of_losses()
             << " % of what damping, cracks, friction and impacts took";
        warned_of_energy = true;
        log.warn(text.str());
      }
  }


  void
  Run::check_cracks()
  {
    if (warned_of_cracks || !model.solid.internal_force.has_memory())
      return;
    const WidestCrack widest = widest_crack(observed);
    warned_of_cracks         = widest.share > widest_share;
    if (!warned_of_cracks)
      return;
    std::ostringstream text;
    text << std::setprecision(3) << "at t = " << state.time
         << " s a crack is open by " << 1e3 * widest.opening << " mm, "
         << 100. * widest.share
         << " % of its cell: what cracks have cut off is loose from now on; "
            "that it comes loose can be relied on, how it moves then cannot";
    log.warn(text.str());
  }


  void
  Run::check_slips()
  {
    if (warned_of_slips || !contact)
      return;
    double       farthest = 0.;
    unsigned int surface  = 0;
    for (const ContactPoint &point : contact->points())
      {
        const double slip = std::hypot(point.gap[1], point.gap[2]);
        if (point.joined && slip > farthest)
          {
            farthest = slip;
            surface  = point.surface;
          }
      }
    const auto all =
      Utilities::MPI::all_gather(log.communicator(),
                                 std::make_pair(farthest, surface));
    std::tie(farthest, surface) = *std::max_element(all.begin(), all.end());
    warned_of_slips             = farthest > 0.5 * contact->cell_size();
    if (!warned_of_slips)
      return;
    std::ostringstream text;
    text << std::setprecision(3) << "at t = " << state.time << " s \""
         << contact->surface_names()[surface] << "\" has slipped by "
         << farthest
         << " m, more than half a cell of the interfaces: nodes still act on "
            "those they faced at the start; that it slides so far can be "
            "relied on, where it comes to rest cannot";
    log.warn(text.str());
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
    log.warn(text.str());
  }


  void
  Run::keep_last_good()
  {
    last_good.displacement = state.displacement;
    last_good.velocity     = state.velocity;
    last_good.time         = state.time;
    if (!model.solid.internal_force.has_memory())
      last_good.memory = state.memory; // for the stress
  }


  void
  Run::attend()
  {
    const OutputParameters &output = model.parameters.output;
    const bool              first =
      Utilities::MPI::this_mpi_process(log.communicator()) == 0;
    const std::string stop_file = folder.path() + "/stop";

    // the first rank looks at the clock and the folder; anybody may have got a
    // signal
    enum
    {
      report,
      save,
      stop_now,
      steps,
      n_wishes
    };
    std::vector<double> mine(n_wishes), wanted(n_wishes);
    mine[stop_now] = stop_requested();
    mine[save]     = take_checkpoint_request();
    if (first)
      {
        mine[report] = log.progress_is_due();
        if (output.checkpoint_interval > 0. &&
            since_checkpoint.wall_time() > 60. * output.checkpoint_interval)
          mine[save] = 1.;
        if (folder.exists() && since_stop_file.wall_time() > 0.5)
          {
            std::error_code none;
            mine[stop_now] =
              std::filesystem::remove(stop_file, none) || mine[stop_now] > 0.;
            since_stop_file.restart();
          }
        const double of_step =
          since_look.wall_time() / std::max<double>(state.step - last_look, 1.);
        mine[steps] =
          std::min(look_interval / std::max(of_step, 1e-9), look_steps);
      }
    Utilities::MPI::max(mine, log.communicator(), wanted);
    last_look = state.step;
    next_look = state.step + 1 + static_cast<unsigned long long>(wanted[steps]);
    since_look.restart();

    if (wanted[report] > 0.)
      report_progress();
    const bool stops = wanted[stop_now] > 0.;
    const bool saved =
      folder.exists() && (stops || wanted[save] > 0.) && write_checkpoint();
    if (stops)
      {
        std::ostringstream text;
        text << "Stopped on request at t = " << state.time << " s"
             << (saved ? "; \"--restart\" goes on from here." :
                         ", without a checkpoint of this time.");
        stop(text.str());
      }
  }


  void
  Run::abort(const std::string &reason)
  {
    std::string written;
    check_contact();
    if (folder.exists())
      {
        const std::string picture =
          write_fields(observed,
                       {{&last_good.displacement, {"displacement"}},
                        {&last_good.velocity, {"velocity"}}},
                       // cracks have gone on since
                       model.solid.internal_force.has_memory() ? nullptr :
                                                                 &last_good,
                       "last_good",
                       last_good.time);
        if (!picture.empty())
          written =
            "; the last good state is in " + folder.path() + "/" + picture;
        write_summary(folder.path(), summary(), "stopped: " + reason, log);
      }
    std::ostringstream text;
    text << "Stopped at t = " << state.time << " s, because " << reason
         << written
         << ". The time step may be too large for the model: take a smaller "
            "\"Safety factor\" in section \"Time\".";
    throw RunStopped(text.str());
  }
} // namespace Voussoir
