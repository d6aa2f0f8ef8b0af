#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/base/version.h>
#include <voussoir/driver/simulation.h>
#include <voussoir/mesh/reservoir_mesh.h>
#include <voussoir/output/field_writer.h>

#include <csignal>
#include <filesystem>
#include <iomanip>

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
    make_mesh(Case &parameters, Log &log)
    {
      std::ostringstream report;
      CoarseMesh         mesh = parameters.make_mesh(report);
      log(report.str());
      return mesh;
    }


    // The water that a mesh may have is a mesh of its own, used or not.
    CoarseMesh
    take_water(const ReservoirParameters &reservoir, CoarseMesh &mesh)
    {
      std::vector<std::string> sets;
      for (const std::string &set : split_list(reservoir.cell_sets))
        if (reservoir.model == "compressible" || mesh.cell_sets.count(set) > 0)
          sets.push_back(set);
      if (sets.empty())
        return {};
      return split_off_reservoir(mesh,
                                 sets,
                                 "\"Cell sets\" in section \"Reservoir\"");
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
    , water_mesh(take_water(parameters.reservoir, coarse_mesh))
    , coarse_materials(parameters.material_of_coarse_cells(coarse_mesh))
    , damping(parameters.damping)
    , materials(parameters.material_list())
    , grid(
        coarse_mesh,
        parameters.grid,
        [this](const unsigned int cell) {
          return materials[coarse_materials[cell]]->relative_cost();
        },
        communicator)
    , discretization(grid,
                     parameters.discretization,
                     (parameters.boundaries.check(grid),
                      parameters.boundaries.supports.list()),
                     [this](const Grid::Cell &cell) {
                       return material_of(cell);
                     })
    , mass(discretization,
           for_each_material(materials,
                             [](const Material &m) {
                               return m.inertial_density();
                             }),
           for_each_material(materials, driven_density),
           [this](const Grid::Cell &cell) { return material_of(cell); })
    , internal_force(discretization,
                     std::vector<const CellKernel *>(materials.begin(),
                                                     materials.end()),
                     for_each_material(materials,
                                       [this](const Material &m) {
                                         return damping.stiffness_factors(
                                           m.damping_factor());
                                       }))
    , boundary(
        discretization,
        parameters.boundaries.absorbing,
        materials,
        [this](const Grid::Cell &cell) { return material_of(cell); },
        parameters.discretization.quadrature,
        terms)
    , initial((report_mesh(), prepare_loads(), find_initial_state()))
    , modes(find_natural_modes())
    , largest_step(find_largest_step())
    , time_step(choose_time_step())
    , scheme(
        discretization,
        internal_force,
        mass,
        damping,
        terms,
        initial,
        projections,
        [this](const double time) {
          std::fill(terms.forces.begin(), terms.forces.end(), Tensor<1, 3>());
          boundary.add_forces(time, terms);
          for (const Load *load : running_loads)
            load->add_forces(time, terms);
          if (reservoir)
            reservoir->add_forces(terms);
        },
        reservoir ?
          [this](const State &now) {
            reservoir->advance(now.velocity,
                               base_motion(now.time - 0.5 * time_step)[1]);
          } :
          std::function<void(const State &)>(),
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
            state.material_memory,
            initial,
            reservoir.get(),
            contact.get(),
            folder,
            time_step,
            parameters.time.end_time,
            [this](const double time) { return base_motion(time); },
            rigid_base(),
            ResultNames(parameters.material_names(), grid, contact.get())}
    , energy(discretization,
             internal_force,
             mass,
             damping,
             terms,
             initial,
             scheme)
  {
    coarse_mesh = CoarseMesh();
    water_mesh  = CoarseMesh();
    if (reservoir)
      reservoir->prepare(time_step);
    report_step();
    prepare_ground_motion();
    for (const auto &observer : parameters.observers)
      observer.second->check(model);
    // a case that is refused up to here leaves nothing behind
    if (!folder.empty())
      open_output();
    if (options.restart)
      read_checkpoint();
    for (Projection *projection : projections)
      projection->start(state);
    energy.evaluate(state);
    keep_last_good();
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
    write_modes();
    energy.open(folder, start_time, options.restart);
    for (const auto &observer : parameters.observers)
      observer.second->prepare(model, start_time, options.restart);
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
            keep_last_good();
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
  Simulation::keep_last_good()
  {
    last_good.displacement = state.displacement;
    last_good.velocity     = state.velocity;
    last_good.time         = state.time;
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
    if (contact)
      text << "Contact: "
           << 100. * result.at("contact share of the loop").get<double>()
           << " % of the loop\n";
    log(text.str());
    log(timer_table());
  }
} // namespace Voussoir
