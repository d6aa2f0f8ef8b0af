// What a run says and writes of itself: its files, progress, summary.

#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/run.h>
#include <voussoir/driver/summary_file.h>
#include <voussoir/files/table.h>
#include <voussoir/output/field_writer.h>
#include <voussoir/output/material_memory.h>
#include <voussoir/signals/response_spectrum.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Spectra of a matched motion beside their targets. */
    void
    write_spectra(const std::vector<SpectrumFit> &fits,
                  const std::string              &folder,
                  Log                            &log)
    {
      if (fits.empty() ||
          Utilities::MPI::this_mpi_process(log.communicator()) != 0)
        return;
      std::vector<std::string>         titles{"period [s]"};
      std::vector<std::vector<double>> columns{fits[0].periods};
      for (const SpectrumFit &fit : fits)
        {
          const std::string component(1, "xyz"[fit.component]);
          titles.push_back(component + " target [m/s2]");
          titles.push_back(component + " scaled record [m/s2]");
          titles.push_back(component + " matched [m/s2]");
          columns.push_back(fit.target);
          columns.push_back(fit.before);
          columns.push_back(fit.after);
        }
      const std::string name = folder + "/ground_motion_spectra.csv";
      log.attempted(name, write_file(name, csv_of_columns(titles, columns)));
    }


    nlohmann::json
    json(const std::vector<SpectrumFit> &fits)
    {
      nlohmann::json result;
      for (const SpectrumFit &fit : fits)
        {
          const auto [largest, at]                     = fit.largest_misfit();
          result[std::string(1, "xyz"[fit.component])] = {
            {"mean misfit [%]", 100. * fit.mean_misfit()},
            {"largest misfit [%]", 100. * largest},
            {"at period [s]", at},
            {"factor", fit.factor},
            {"Arias intensity of the scaled record [m/s]", fit.arias_before},
            {"Arias intensity [m/s]", fit.arias_after}};
        }
      return result;
    }
  } // namespace


  void
  Run::open_output()
  {
    write_modes();
    write_ground_motion();
    write_spectra(earthquake.fits, folder.path(), log);
    energy.open(folder.path(), folder.start_time(), folder.restarts(), log);
    for (const auto &observer : setup->observers)
      observer.second->prepare(observed,
                               folder.start_time(),
                               folder.restarts());
  }


  void
  Run::write_modes() const
  {
    if (modes.list.empty())
      return;
    std::vector<NodalField> fields;
    for (unsigned int j = 0; j < modes.list.size(); ++j)
      {
        std::ostringstream name;
        name << std::setprecision(4) << "mode " << j + 1 << " ("
             << modes.list[j].frequency << " Hz)";
        fields.push_back({&modes.list[j].shape, {name.str()}});
      }
    write_fields(observed, fields, nullptr, "modes", 0.);
  }


  void
  Run::write_ground_motion() const
  {
    const auto              &components = earthquake.accelerations;
    std::vector<std::string> titles{"time [s]"};
    std::size_t              n_samples = 0;
    for (unsigned int d = 0; d < 3; ++d)
      if (!components[d].empty())
        {
          titles.push_back(std::string("acceleration ") + "xyz"[d] + " [m/s2]");
          n_samples = components[d].size();
        }
    if (n_samples == 0 ||
        Utilities::MPI::this_mpi_process(log.communicator()) != 0)
      return;
    std::string text = csv_heading(titles) + '\n';
    for (std::size_t i = 0; i < n_samples; ++i)
      {
        std::vector<double> line{i * Earthquake::sample_interval};
        for (const auto &component : components)
          if (!component.empty())
            line.push_back(component[i]);
        text += csv_line(line) + '\n';
      }
    const std::string name = folder.path() + "/ground_motion.csv";
    log.attempted(name, write_file(name, text));
  }


  namespace
  {
    /** The spectrum that an artificial or matched motion follows [m/s2]. */
    nlohmann::json
    target_spectrum(const GroundMotion &motion)
    {
      constexpr double shortest = 0.03, longest = 4.;
      nlohmann::json   result{{"damping ratio", motion.spectrum.damping_ratio}};
      for (const double period : logarithmic_grid(shortest, longest, 50))
        {
          result["periods [s]"].push_back(period);
          for (unsigned int d = 0; d < 3; ++d)
            if (const double peak = motion.peak_acceleration(d).value_or(0.);
                peak > 0.)
              result[std::string(1, "xyz"[d]) + " [m/s2]"].push_back(
                motion.overload_factor * standard_gravity * peak *
                motion.spectrum.spectrum.amplification(period));
        }
      return result;
    }
  } // namespace


  void
  Run::report_progress()
  {
    const double done =
      double(state.step - first_step) / double(n_steps() - first_step);
    const double       seconds = clock.wall_time();
    std::ostringstream text;
    text << std::fixed << std::setprecision(3) << "t = " << state.time
         << " s  time left " << duration_text(seconds * (1. - done) / done)
         << "  energy-balance error " << 100. * energy.relative_error()
         << " %  " << std::setprecision(1) << throughput(seconds)
         << " MDOF-steps/s";
    log.progress(double(state.step) / double(n_steps()), text.str());
  }


  double
  Run::throughput(const double seconds) const
  {
    return 1e-6 * double(model.solid.discretization.dof_handler.n_dofs()) *
           double(state.step - first_step) / seconds;
  }


  nlohmann::json
  Run::summary() const
  {
    const MPI_Comm communicator = log.communicator();
    nlohmann::json result       = setup->summary(communicator);
    result["steps"]             = state.step;
    result["end time [s]"]      = state.time;
    result["loop time [s]"]     = loop_seconds;
    result["MDOF-steps/s"] = loop_seconds > 0. ? throughput(loop_seconds) : 0.;
    // the rank that comes last to the exchange of contact does not wait there
    if (contact && loop_seconds > 0.)
      result["contact share of the loop"] =
        Utilities::MPI::min(contact->seconds(), communicator) / loop_seconds;
    if (const GroundMotion &motion = model.parameters.ground_motion;
        motion.type == GroundMotionType::spectrum || motion.match.wanted())
      result["target spectrum"] = target_spectrum(motion);
    if (!earthquake.fits.empty())
      result["spectrum fit"] = json(earthquake.fits);
    if (!rest.summary.is_null())
      result["static state"] = rest.summary;
    if (!modes.list.empty())
      result["modes"] = modes.summary();
    if (water)
      result["reservoir"] = {{"unknowns",
                              model.reservoir->space.dof_handler.n_dofs()},
                             {"stored energy [J]", water->stored_energy()},
                             {"radiated and absorbed [J]",
                              Utilities::MPI::sum(water->loss, communicator)}};
    if (model.solid.internal_force.has_memory())
      result["materials"] =
        memory_summary(observed, model.parameters.material_names());
    result["energy balance"] = energy.summary();
    return result;
  }


  void
  Run::finish()
  {
    loop_seconds = clock.wall_time();
    check_contact();
    nlohmann::json result = summary();
    if (folder.exists())
      {
        TimerOutput::Scope scope(timer, "output");
        for (const auto &observer : setup->observers)
          observer.second->finish(state, result);
        log.write_growing_files();
        log.look_for_lost_files();
        write_summary(folder.path(),
                      result,
                      log.warnings().empty() ? "no objection" :
                                               "with warnings, see there",
                      log);
      }

    std::ostringstream text;
    const bool         complete = log.missing_files().empty();
    text << std::setprecision(3)
         << (complete ? "Done: " : "Done, but not all is written: ")
         << state.step - first_step << " steps in "
         << duration_text(loop_seconds) << ", " << throughput(loop_seconds)
         << " MDOF-steps/s, energy-balance error "
         << 100. * energy.relative_error() << " %\n";
    if (contact)
      text << "Contact: "
           << 100. * result.at("contact share of the loop").get<double>()
           << " % of the loop, " << contact->effort().paths
           << " clusters by path following\n";
    for (const std::string &warning : log.warnings())
      text << "Warning: " << warning << '\n';
    log(text.str());
    log(timer_table());
  }


  void
  Run::refuse_missing_files() const
  {
    const auto missing = log.missing_files();
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
      "; see to it and run the case again.");
  }


  std::string
  Run::timer_table() const
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
