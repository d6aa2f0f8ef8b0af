#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/text.h>
#include <voussoir/base/version.h>
#include <voussoir/driver/simulation.h>
#include <voussoir/output/field_writer.h>

#include <csignal>
#include <filesystem>
#include <iomanip>
#include <set>

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    // set by SIGINT and SIGTERM: finish the step, write a checkpoint, stop
    volatile std::sig_atomic_t stop_requested = 0;

    void
    request_stop(int)
    {
      stop_requested = 1;
    }


    /** The output folder; without --overwrite the next free number is added,
     *  and a restart goes on in the one that was written last. */
    std::string
    choose_folder(const Case       &parameters,
                  const RunOptions &options,
                  const MPI_Comm    communicator)
    {
      if (options.no_output)
        return "";
      const std::string wanted = parameters.output.folder.empty() ?
                                   "output/" + parameters.file.name() :
                                   parameters.output.folder;
      if (options.overwrite && !options.restart)
        {
          if (fs::exists(wanted) && !fs::exists(wanted + "/parameters.prm"))
            throw UserError("--overwrite does not remove \"" + wanted +
                            "\", which holds no parameters.prm of an earlier "
                            "run; choose another \"Folder\" in section "
                            "\"Output\".");
          return wanted;
        }
      std::string next = wanted, last = wanted;
      if (Utilities::MPI::this_mpi_process(communicator) == 0)
        for (unsigned int n = 2; fs::exists(next); ++n)
          {
            last = next;
            next = wanted + "-" + std::to_string(n);
          }
      const std::string chosen =
        Utilities::MPI::broadcast(communicator, options.restart ? last : next);
      if (options.restart && !Checkpoint::exists(chosen + "/checkpoint"))
        throw UserError("There is no checkpoint in \"" + chosen +
                        "\" to restart from; run the case without "
                        "--restart.");
      return chosen;
    }


    CoarseMesh
    make_mesh(const Case &parameters, Log &log)
    {
      std::ostringstream report;
      CoarseMesh         mesh = parameters.make_mesh(report);
      log(report.str());
      return mesh;
    }


    // The moduli hold at the reference frequency of the damping.
    std::vector<const Material *>
    scaled_materials(Case &parameters, const Damping &damping)
    {
      for (auto &item : parameters.materials.objects)
        item.second->stiffness_scale =
          damping.stiffness_scale(item.second->damping_factor());
      return parameters.material_list();
    }


    template <typename Function>
    std::vector<double>
    for_each_material(const std::vector<const Material *> &materials,
                      const Function                      &function)
    {
      std::vector<double> values;
      for (const Material *material : materials)
        values.push_back(function(*material));
      return values;
    }


    double
    driven_density(const Material &material)
    {
      return material.inertia_factor < 1. ? 0. : material.density;
    }
  } // namespace


  Simulation::Simulation(Case             &parameters,
                         const RunOptions &options,
                         const MPI_Comm    communicator)
    : parameters(parameters)
    , options(options)
    , log(communicator, options.quiet)
    , timer(std::cout, TimerOutput::never, TimerOutput::wall_times)
    , folder(choose_folder(parameters, options, communicator))
    , coarse_mesh(
        (report_start(), check_checkpoint(), make_mesh(parameters, log)))
    , coarse_materials(parameters.material_of_coarse_cells(coarse_mesh))
    , damping(parameters.damping)
    , materials(scaled_materials(parameters, damping))
    , grid(
        coarse_mesh,
        parameters.grid,
        [this](const unsigned int cell) {
          return materials[coarse_materials[cell]]->relative_cost();
        },
        communicator)
    , discretization(
        grid,
        parameters.discretization,
        (parameters.boundaries.check(grid), parameters.boundaries.supports()),
        [this](const Grid::Cell &cell) { return material_of(cell); })
    , mass(discretization,
           for_each_material(materials,
                             [](const Material &m) {
                               return m.inertial_density();
                             }),
           for_each_material(materials, driven_density),
           [this](const Grid::Cell &cell) { return material_of(cell); })
    , internal_force(discretization,
                     std::vector<const CellKernel *>(materials.begin(),
                                                     materials.end()))
    , boundary(
        discretization,
        parameters.boundaries,
        materials,
        [this](const Grid::Cell &cell) { return material_of(cell); },
        parameters.discretization.quadrature,
        terms)
    , largest_step((prepare_loads(), report_mesh(), find_largest_step()))
    , time_step(choose_time_step())
    , scheme(
        discretization,
        internal_force,
        mass,
        damping,
        terms,
        projections,
        [this](const double time) {
          std::fill(terms.forces.begin(), terms.forces.end(), Tensor<1, 3>());
          boundary.add_forces(time, terms);
          for (const auto &load : this->parameters.loads.objects)
            load.second->add_forces(time, terms);
        },
        rigid_base() ?
          [this](const double time) { return base_motion(time)[2]; } :
          std::function<Tensor<1, 3>(const double)>(),
        parameters.time.scheme == "paper",
        time_step)
    , state(scheme.state_at_rest())
    , checkpoint(discretization, folder + "/checkpoint")
    , model{discretization,
            materials,
            [this](const Grid::Cell &cell) { return material_of(cell); },
            folder,
            time_step,
            parameters.time.end_time,
            [this](const double time) { return base_motion(time); }}
    , energy(discretization, internal_force, mass, damping, terms, scheme)
  {
    coarse_mesh = CoarseMesh();
    report_step();
    prepare_ground_motion();
    for (const auto &observer : parameters.observers)
      observer.second->check(model);
    // a case that is refused up to here leaves nothing behind
    if (!folder.empty())
      open_output();
    if (options.restart)
      read_checkpoint();
    energy.evaluate(state);
    last_good = state;
  }


  void
  Simulation::report_start()
  {
    log.line("Voussoir ", version(), " with deal.II " DEAL_II_PACKAGE_VERSION);
#ifdef DEBUG
    log.line("DEBUG build: every check is on, and it is some thirty times "
             "slower than a Release build.");
#endif
    log.line("Ranks: ",
             Utilities::MPI::n_mpi_processes(log.communicator()),
             " of one thread, SIMD: ",
             simd_description());
    if (!parameters.title.empty())
      log.line(parameters.title);
    if (!folder.empty())
      log.line("Results go to ", folder);
  }


  void
  Simulation::open_output()
  {
    const bool first =
      Utilities::MPI::this_mpi_process(grid.communicator()) == 0;
    std::error_code problem;
    if (first)
      {
        if (options.overwrite && !options.restart)
          fs::remove_all(folder, problem);
        if (!problem)
          fs::create_directories(folder, problem);
      }
    if (Utilities::MPI::max(problem ? 1 : 0, grid.communicator()) == 1)
      throw UserError("The output folder \"" + folder +
                      "\" cannot be made; choose another \"Folder\" in "
                      "section \"Output\".");

    log.open(folder + "/log.txt", options.restart);
    if (first)
      {
        std::ofstream prm(folder + "/parameters.prm");
        parameters.prm.print_parameters(prm, ParameterHandler::Text);
      }
    const double start_time = options.restart ?
                                Checkpoint::read_header(folder + "/checkpoint")
                                  .at("time")
                                  .get<double>() :
                                0.;
    energy.open(folder, start_time, options.restart);
    for (const auto &observer : parameters.observers)
      observer.second->prepare(model, start_time, options.restart);
  }


  unsigned int
  Simulation::material_of(const Grid::Cell &cell) const
  {
    return coarse_materials[Grid::coarse_cell(cell)];
  }


  bool
  Simulation::rigid_base() const
  {
    return parameters.ground_motion.type != "none" &&
           parameters.wave.enters_through == "rigid base";
  }


  std::array<Tensor<1, 3>, 3>
  Simulation::base_motion(const double time) const
  {
    std::array<Tensor<1, 3>, 3> motion;
    for (unsigned int d = 0; d < 3; ++d)
      if (base_signals[d])
        {
          motion[0][d] = base_signals[d]->displacement(time);
          motion[1][d] = base_signals[d]->velocity(time);
          motion[2][d] = base_signals[d]->acceleration(time);
        }
    return motion;
  }


  void
  Simulation::prepare_loads()
  {
    for (const auto &[name, load] : parameters.loads.objects)
      load->prepare(discretization, terms, parameters.file, "Loads/" + name);
    for (const auto &[name, projection] : parameters.projections.objects)
      {
        projection->prepare(discretization,
                            mass,
                            parameters.file,
                            "Constraints/" + name);
        projections.push_back(projection.get());
      }
  }


  void
  Simulation::prepare_ground_motion()
  {
    if (parameters.ground_motion.type == "none")
      return;
    GroundMotionSignals motion =
      parameters.ground_motion.build(parameters.file.folder());
    log(parameters.ground_motion.summary(motion, parameters.time.end_time));
    if (rigid_base())
      base_signals = std::move(motion);
    else
      boundary.set_free_field(
        make_free_field(boundary,
                        discretization,
                        materials,
                        parameters.discretization.quadrature,
                        damping,
                        parameters.wave,
                        parameters.ground_motion.given_at,
                        std::move(motion),
                        parameters.time.scheme == "paper",
                        time_step,
                        parameters.time.end_time));
  }


  void
  Simulation::report_mesh()
  {
    log.line("Mesh: ",
             grid.describe_balance(),
             ", partition by ",
             parameters.grid.partition,
             ", at most ",
             discretization.largest_interface(),
             " nodes of a rank owned by others");
    log.line("Unknowns: ",
             discretization.dof_handler.n_dofs(),
             " of degree ",
             discretization.degree);
    // longest edge of the cells of each material
    std::vector<double> longest(materials.size(), 0.);
    for (const auto &cell : grid.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        for (unsigned int line = 0; line < 12; ++line)
          {
            double &edge = longest[material_of(cell)];
            edge         = std::max(edge, cell->line(line)->diameter());
          }
    for (unsigned int m = 0; m < materials.size(); ++m)
      {
        const ElasticConstants c = materials[m]->elastic_constants();
        const double           edge =
          Utilities::MPI::max(longest[m], grid.communicator());
        std::ostringstream text;
        text << std::setprecision(4) << "Material "
             << parameters.materials.objects[m].first << ": mass "
             << mass.total[m] << " kg, P wave " << c.p_wave_speed()
             << " m/s, S wave " << c.s_wave_speed()
             << " m/s; its largest cells carry waves up to "
             << std::setprecision(2)
             << c.s_wave_speed() * discretization.degree / (8. * edge)
             << " Hz with 8 nodes per wavelength";
        log.line(text.str());
      }
  }


  double
  Simulation::find_largest_step()
  {
    TimerOutput::Scope scope(timer, "stable step");
    std::ostringstream text;
    const ElementSteps elements(
      discretization,
      std::vector<const CellKernel *>(materials.begin(), materials.end()),
      for_each_material(materials, [](const Material &m) {
        return m.inertial_density();
      }));
    elements.print(text);
    log(text.str());

    const bool   paper = parameters.time.scheme == "paper";
    const double alpha = damping.mass_coefficient;
    StepLimits   limits;
    limits.stiffening = [&](const double dt) { return damping.stiffening(dt); };
    limits.add_diagonal =
      [&](Vector &force, const Vector &displacement, const double dt) {
        terms.add_to(force, displacement, paper ? 2. / dt : 0.);
        if (paper && alpha > 0.)
          for (unsigned int i = 0; i < force.locally_owned_size(); ++i)
            force.local_element(i) += 2. / dt * alpha *
                                      mass.mass.local_element(i) *
                                      displacement.local_element(i);
      };
    undamped_step =
      damping.stiffening(1.) > 0. ?
        stable_step(discretization,
                    internal_force,
                    mass,
                    {[](const double) { return 0.; },
                     [](Vector &, const Vector &, const double) {}}) :
        0.;
    return stable_step(discretization, internal_force, mass, limits);
  }


  double
  Simulation::choose_time_step()
  {
    if (options.restart)
      return Checkpoint::read_header(folder + "/checkpoint").at("time step");
    const double given = parameters.time.time_step;
    if (given > largest_step)
      {
        std::ostringstream text;
        text << std::setprecision(3) << "\"Time step\" in section \"Time\" is "
             << given << " s, but the largest stable one is " << largest_step
             << " s; choose a smaller one, or 0 for the automatic choice.";
        throw UserError(text.str());
      }
    return given > 0. ? given : parameters.time.safety_factor * largest_step;
  }


  void
  Simulation::report_step()
  {
    std::ostringstream text;
    damping.print(text);
    text << std::setprecision(4) << "Time step: " << time_step
         << " s, largest stable " << largest_step << " s";
    if (undamped_step > 0.)
      text << " (" << std::setprecision(3)
           << 100. * largest_step / undamped_step << " % of the undamped "
           << std::setprecision(4) << undamped_step << " s)";
    text << ", " << n_steps() << " steps to " << parameters.time.end_time
         << " s\n";
    log(text.str());
  }


  unsigned long long
  Simulation::n_steps() const
  {
    return std::ceil(parameters.time.end_time / time_step - 1e-9);
  }


  void
  Simulation::run()
  {
    stop_requested = 0;
    std::signal(SIGINT, request_stop);
    std::signal(SIGTERM, request_stop);
    const Schedule           energy_schedule(parameters.output.energy_interval,
                                   time_step);
    const unsigned long long last_step = n_steps();
    first_step                         = state.step;
    clock.restart();
    since_report.restart();
    since_checkpoint.restart();
    // after a restart the observers see again what they saw last
    observe();

    while (state.step < last_step)
      {
        {
          TimerOutput::Scope scope(timer, "step");
          scheme.step(state);
        }
        observe();
        if (energy_schedule.due(state.step) || state.step == last_step)
          {
            TimerOutput::Scope scope(timer, "energy balance");
            energy.evaluate(state);
            if (const std::string reason = energy.alarm(); !reason.empty())
              abort_run(reason);
            last_good = state;
            attend(); // progress, checkpoint, stop on request
          }
      }
    finish();
  }


  void
  Simulation::observe()
  {
    if (folder.empty())
      return;
    TimerOutput::Scope scope(timer, "output");
    for (const auto &observer : parameters.observers)
      observer.second->observe(state);
  }


  void
  Simulation::attend()
  {
    // all ranks go by the clock of the first
    std::array<int, 3> due{{since_report.wall_time() > 5. ? 1 : 0,
                            parameters.output.checkpoint_interval > 0. &&
                                since_checkpoint.wall_time() >
                                  60. * parameters.output.checkpoint_interval ?
                              1 :
                              0,
                            stop_requested != 0 ? 1 : 0}};
    due = Utilities::MPI::broadcast(grid.communicator(), due);
    if (due[0])
      {
        report_progress();
        since_report.restart();
      }
    if (!folder.empty() && (due[1] || due[2]))
      write_checkpoint();
    if (due[2])
      throw UserError("Stopped on request at " + std::to_string(state.time) +
                      " s; \"--restart\" goes on from here.");
  }


  void
  Simulation::report_progress()
  {
    const double done =
      double(state.step - first_step) / double(n_steps() - first_step);
    const double       seconds = clock.wall_time();
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << std::setw(5)
         << 100. * double(state.step) / double(n_steps())
         << " %  t = " << std::setprecision(3) << state.time << " s  "
         << std::setprecision(1) << throughput(seconds)
         << " MDOF-steps/s  energy error " << std::setprecision(3)
         << 100. * energy.relative_error() << " %  time left "
         << duration_text(seconds * (1. - done) / done);
    log.line(text.str());
  }


  double
  Simulation::throughput(const double seconds) const
  {
    return 1e-6 * double(discretization.dof_handler.n_dofs()) *
           double(state.step - first_step) / seconds;
  }


  std::map<std::string, Vector *>
  Simulation::checkpoint_vectors()
  {
    std::map<std::string, Vector *> vectors{{"displacement",
                                             &state.displacement},
                                            {"velocity", &state.velocity}};
    for (unsigned int i = 0; i < state.memory.size(); ++i)
      vectors["damping memory " + std::to_string(i)] = &state.memory[i];
    for (const auto &[name, observer] : parameters.observers)
      for (const auto &[vector_name, vector] : observer->checkpoint_vectors())
        vectors[name + "/" + vector_name] = vector;
    return vectors;
  }


  nlohmann::json
  Simulation::physics() const
  {
    // what must not change between a checkpoint and the run that goes on,
    // each as "Section/Entry = value"
    const std::set<std::string> free{"Title",
                                     "Mesh/Partition",
                                     "Time/End time"};
    std::ostringstream          text;
    parameters.prm.print_parameters(text, ParameterHandler::ShortText);
    nlohmann::json           result = nlohmann::json::array();
    std::istringstream       in(text.str());
    std::vector<std::string> sections;
    for (std::string line; std::getline(in, line);)
      {
        line              = Utilities::trim(line);
        const auto equals = line.find('=');
        if (line.rfind("subsection ", 0) == 0)
          sections.push_back(line.substr(11) + "/");
        else if (line == "end")
          sections.pop_back();
        else if (line.rfind("set ", 0) == 0)
          {
            const std::string entry =
              join(sections, "") + Utilities::trim(line.substr(4, equals - 4));
            if (free.count(entry) == 0 && entry.rfind("Output/", 0) != 0)
              result.push_back(entry + " =" + line.substr(equals + 1));
          }
      }
    return result;
  }


  void
  Simulation::write_checkpoint()
  {
    TimerOutput::Scope scope(timer, "checkpoint");
    nlohmann::json     seen;
    for (const auto &[name, observer] : parameters.observers)
      seen[name] = observer->save();
    checkpoint.write(checkpoint_vectors(),
                     {{"time", state.time},
                      {"step", state.step},
                      {"time step", time_step},
                      {"energy", energy.save()},
                      {"work", accumulated_work()},
                      {"observers", seen},
                      {"physics", physics()}});
    log.line("Checkpoint written at t = ", state.time, " s");
    since_checkpoint.restart();
  }


  std::vector<double>
  Simulation::accumulated_work() const
  {
    return sum_over_ranks(std::vector<double>{terms.work_of_forces,
                                              terms.loss_in_dashpots,
                                              scheme.work_of_base,
                                              scheme.work_of_projections,
                                              scheme.loss_by_mass},
                          grid.communicator());
  }


  void
  Simulation::check_checkpoint()
  {
    if (!options.restart)
      return;
    const nlohmann::json header =
      Checkpoint::read_header(folder + "/checkpoint");
    const nlohmann::json mine = physics(), theirs = header.at("physics");
    const auto           line = [](const nlohmann::json &lines, std::size_t i) {
      return i < lines.size() ? Utilities::trim(lines[i].get<std::string>()) :
                                          std::string("nothing");
    };
    for (std::size_t i = 0; i < std::max(mine.size(), theirs.size()); ++i)
      if (line(mine, i) != line(theirs, i))
        throw UserError("The checkpoint in \"" + folder +
                        "\" was written with \"" + line(theirs, i) +
                        "\", the case now has \"" + line(mine, i) +
                        "\"; restart with the same physics, or start "
                        "afresh.");
    const double reached = header.at("time");
    if (reached >= parameters.time.end_time)
      {
        std::ostringstream text;
        text << "The checkpoint in \"" << folder << "\" is of " << reached
             << " s, but \"End time\" in section \"Time\" is "
             << parameters.time.end_time << " s; set a later one.";
        throw UserError(text.str());
      }
  }


  void
  Simulation::read_checkpoint()
  {
    const nlohmann::json header =
      Checkpoint::read_header(folder + "/checkpoint");
    checkpoint.read(checkpoint_vectors());
    state.time = header.at("time");
    state.step = header.at("step");
    energy.load(header.at("energy"));
    for (const auto &[name, observer] : parameters.observers)
      if (header.at("observers").contains(name))
        observer->load(header.at("observers").at(name));
    const std::vector<double> work = header.at("work");
    if (Utilities::MPI::this_mpi_process(grid.communicator()) == 0)
      {
        terms.work_of_forces       = work[0];
        terms.loss_in_dashpots     = work[1];
        scheme.work_of_base        = work[2];
        scheme.work_of_projections = work[3];
        scheme.loss_by_mass        = work[4];
      }
    // the free field has no checkpoint: it is marched again, which is cheap
    for (unsigned long long step = 0; step < state.step; ++step)
      boundary.replay(step * time_step);
    log.line("Going on from the checkpoint at t = ", state.time, " s");
  }


  void
  Simulation::abort_run(const std::string &reason)
  {
    std::string written;
    if (!folder.empty())
      {
        write_fields(model,
                     {{&last_good.displacement, {"displacement"}},
                      {&last_good.velocity, {"velocity"}}},
                     &last_good.displacement,
                     "last_good",
                     last_good.time);
        written = "; the last good state is in " + folder + "/last_good.vtu";
      }
    std::ostringstream text;
    text << "Stopped at t = " << state.time << " s, because " << reason
         << written
         << ". The time step may be too large for the model: take a smaller "
            "\"Safety factor\" in section \"Time\".";
    throw UserError(text.str());
  }


  nlohmann::json
  Simulation::summary() const
  {
    nlohmann::json result;
    result["version"]   = version();
    result["title"]     = parameters.title;
    result["SIMD bits"] = 64 * Lanes::size();
    result["ranks"]     = Utilities::MPI::n_mpi_processes(grid.communicator());
    result["cells"]     = grid.triangulation().n_global_active_cells();
    result["unknowns"]  = discretization.dof_handler.n_dofs();
    result["degree"]    = discretization.degree;
    result["time step [s]"]           = time_step;
    result["largest stable step [s]"] = largest_step;
    result["steps"]                   = state.step;
    result["end time [s]"]            = state.time;
    result["loop time [s]"]           = loop_seconds;
    result["MDOF-steps/s"] = loop_seconds > 0. ? throughput(loop_seconds) : 0.;
    Utilities::System::MemoryStats memory;
    Utilities::System::get_memory_stats(memory);
    result["peak memory of a rank [MB]"] =
      Utilities::MPI::max(memory.VmHWM / 1024., grid.communicator());
    result["energy balance"] = energy.summary();
    return result;
  }


  void
  Simulation::finish()
  {
    loop_seconds          = clock.wall_time();
    nlohmann::json result = summary();
    if (!folder.empty())
      {
        TimerOutput::Scope scope(timer, "output");
        for (const auto &observer : parameters.observers)
          observer.second->finish(state, result);
        if (Utilities::MPI::this_mpi_process(grid.communicator()) == 0)
          std::ofstream(folder + "/summary.json")
            << result.dump(2) << std::endl;
      }

    std::ostringstream text;
    text << std::setprecision(3) << "Done: " << state.step - first_step
         << " steps in " << duration_text(loop_seconds) << ", "
         << throughput(loop_seconds) << " MDOF-steps/s, energy error "
         << 100. * energy.relative_error() << " %\n";
    log(text.str());
    log(timer_table());
  }


  std::string
  Simulation::timer_table() const
  {
    std::ostringstream text;
    const auto         times =
      timer.get_summary_data(TimerOutput::OutputData::total_wall_time);
    const auto calls = timer.get_summary_data(TimerOutput::OutputData::n_calls);
    text << "  seconds      calls  section\n" << std::fixed;
    for (const auto &[name, seconds] : times)
      text << std::setw(9) << std::setprecision(2) << seconds << "  "
           << std::setw(9) << std::setprecision(0) << calls.at(name) << "  "
           << name << '\n';
    return text.str();
  }
} // namespace Voussoir
