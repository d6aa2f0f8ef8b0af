// What a simulation says of itself: mesh, time step, progress, summary.

#include <voussoir/base/version.h>
#include <voussoir/driver/simulation.h>
#include <voussoir/output/material_memory.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

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
    // longest edge and widest crack band of the cells of each material
    std::vector<double> longest(materials.size(), 0.), widest(longest);
    for (const auto &cell : grid.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int m = material_of(cell);
          for (unsigned int line = 0; line < 12; ++line)
            longest[m] = std::max(longest[m], cell->line(line)->diameter());
          widest[m] =
            std::max(widest[m],
                     PointHistory::element_length_of(cell,
                                                     discretization.degree));
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
        const double band = Utilities::MPI::max(widest[m], grid.communicator());
        if (const std::string remark = materials[m]->remark(band);
            !remark.empty())
          log.line("  note: ", remark);
      }
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
    // the rank that comes last to the exchange of contact does not wait there
    if (contact && loop_seconds > 0.)
      result["contact share of the loop"] =
        Utilities::MPI::min(contact->seconds(), grid.communicator()) /
        loop_seconds;
    if (!static_summary.is_null())
      result["static state"] = static_summary;
    if (!modes.list.empty())
      result["modes"] = modes.summary();
    if (reservoir)
      result["reservoir"] = {
        {"unknowns", reservoir->space.dof_handler.n_dofs()},
        {"stored energy [J]", reservoir->stored_energy()},
        {"radiated and absorbed [J]",
         Utilities::MPI::sum(reservoir->loss, grid.communicator())}};
    if (internal_force.has_memory())
      result["materials"] = memory_summary(model, parameters.material_names());
    result["energy balance"] = energy.summary();
    result["names"]          = model.names.json();
    return result;
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
