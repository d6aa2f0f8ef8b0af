#include <voussoir/base/json_entries.h>
#include <voussoir/base/machine.h>
#include <voussoir/base/text.h>
#include <voussoir/base/version.h>
#include <voussoir/driver/crack_refinement.h>
#include <voussoir/driver/run.h>
#include <voussoir/driver/run_summary.h>
#include <voussoir/driver/verdict_tables.h>
#include <voussoir/mesh/mesh_quality.h>
#include <voussoir/output/material_memory.h>
#include <voussoir/signals/response_spectrum.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  // The names in summary.json.

  template <typename Entry>
  void
  for_each_entry(CellQuality &part, const Entry &entry)
  {
    entry("smallest scaled Jacobian", part.scaled_jacobian);
    entry("largest aspect ratio", part.aspect_ratio);
    entry("smallest angle [degrees]", part.smallest_angle);
  }


  template <typename Entry>
  void
  for_each_entry(ModelSummary &part, const Entry &entry)
  {
    entry("version", part.version);
    entry("title", part.title);
    entry("SIMD bits", part.simd_bits);
    entry("ranks", part.n_ranks);
    entry("cells", part.n_cells);
    entry("mesh quality", part.mesh_quality);
    entry("unknowns", part.n_unknowns);
    entry("degree", part.degree);
    entry("peak memory of a rank [MB]", part.peak_memory);
    entry("names", part.names);
    entry("refined where cracks are expected", part.refinement);
    entry("counted partitions", part.partitions);
  }


  template <typename Entry>
  void
  for_each_entry(DampingSummary &part, const Entry &entry)
  {
    entry("model", part.model);
    entry("moduli hold at [Hz]", part.reference_frequency);
    entry("relaxed modulus over the given one", part.modulus_at_rest);
  }


  template <typename Entry>
  void
  for_each_entry(StepSummary &part, const Entry &entry)
  {
    entry("time step [s]", part.length);
    entry("largest stable step [s]", part.limit);
    entry("damping", part.damping);
  }


  template <typename Entry>
  void
  for_each_entry(FitSummary &part, const Entry &entry)
  {
    entry("mean misfit [%]", part.mean_misfit);
    entry("largest misfit [%]", part.largest_misfit);
    entry("at period [s]", part.period);
    entry("factor", part.factor);
    entry("Arias intensity of the scaled record [m/s]", part.arias_before);
    entry("Arias intensity [m/s]", part.arias_after);
  }


  template <typename Entry>
  void
  for_each_entry(TargetSpectrum &part, const Entry &entry)
  {
    entry("damping ratio", part.damping_ratio);
    entry("periods [s]", part.periods);
    entry("x [m/s2]", part.components[0]);
    entry("y [m/s2]", part.components[1]);
    entry("z [m/s2]", part.components[2]);
  }


  template <typename Entry>
  void
  for_each_entry(WaterSummary &part, const Entry &entry)
  {
    entry("unknowns", part.n_unknowns);
    entry("stored energy [J]", part.stored);
    entry("radiated and absorbed [J]", part.lost);
  }


  template <typename Entry>
  void
  for_each_entry(MarchSummary &part, const Entry &entry)
  {
    entry("steps", part.n_steps);
    entry("end time [s]", part.end_time);
    entry("loop time [s]", part.loop_time);
    entry("MDOF-steps/s", part.throughput);
    entry("contact share of the loop", part.contact_share);
    entry("time of cells, largest over mean of the ranks", part.balance);
    entry("target spectrum", part.target_spectrum);
    entry("spectrum fit", part.fits);
    entry("static state", part.static_state);
    entry("modes", part.modes);
    entry("reservoir", part.reservoir);
    entry("materials", part.materials);
    entry("detachment", part.detachment);
    entry("energy balance", part.energy);
  }


  // Conversion of any struct with for_each_entry() to JSON and back.

  template <typename Part>
  auto
  to_json(nlohmann::json &json, const Part &part)
    -> decltype(for_each_entry(const_cast<Part &>(part), 0))
  {
    write_entries(json, part);
  }


  template <typename Part>
  auto
  from_json(const nlohmann::json &json, Part &part)
    -> decltype(for_each_entry(part, 0))
  {
    read_entries(json, part);
  }


  namespace
  {
    constexpr char stopped[] = "stopped: ", failed[] = "failed: ";


    /** The tables of the verdict and their names. */
    template <typename Summary>
    auto
    tables_of(Summary &summary)
    {
      using Table = std::pair<const char *, decltype(&summary.checks)>;
      return std::array<Table, 3>{{{"numerical checks", &summary.checks},
                                   {"engineering results", &summary.results},
                                   {"acceptance table", &summary.acceptance}}};
    }


    /** Reads a part of the summary if the summary has its entry @p name, and
     *  removes the entries of the part from the rest. */
    template <typename Part>
    void
    take(const nlohmann::json &json,
         const char           *name,
         std::optional<Part>  &part,
         nlohmann::json       &left)
    {
      Part read{};
      if (json.contains(name))
        read_entries(json, part.emplace());
      for_each_entry(read, [&left](const char *name, const auto &) {
        left.erase(name);
      });
    }
  } // namespace


  std::string
  RunSummary::verdict() const
  {
    if (end == RunEnd::stopped)
      return stopped + reason;
    if (end == RunEnd::failed)
      return failed + reason;
    std::vector<std::string> bad, open;
    for (const auto &item : tables_of(*this))
      {
        for (const std::string &name : not_met(*item.second))
          bad.push_back(name);
        for (const std::string &name : not_judged(*item.second))
          open.push_back(name);
      }
    if (!bad.empty())
      return "not met: " + join(bad, "; ");
    if (!open.empty())
      return "to be judged: " + join(open, "; ");
    return warnings.empty() ? "no objection" : "with warnings, see there";
  }


  std::string
  RunSummary::short_verdict() const
  {
    const std::string whole = verdict(),
                      first = whole.substr(0, whole.find(". "));
    return first.substr(0, first.find_last_not_of('.') + 1);
  }


  void
  RunSummary::judge(const AcceptanceParameters &criteria)
  {
    const nlohmann::json summary(*this);
    results    = engineering_results(summary);
    acceptance = criteria.table(summary);
  }


  void
  to_json(nlohmann::json &json, const RunSummary &summary)
  {
    json = summary.observers;
    if (summary.model)
      write_entries(json, *summary.model);
    if (summary.step)
      write_entries(json, *summary.step);
    if (summary.march)
      write_entries(json, *summary.march);
    for (const auto &[name, table] : tables_of(summary))
      write_entry(json, name, *table);
    json["verdict"] = summary.verdict();
    if (summary.model)
      json["warnings"] = summary.warnings;
    write_entry(json, "files not written", summary.missing_files);
  }


  void
  from_json(const nlohmann::json &json, RunSummary &summary)
  {
    summary                   = {};
    const std::string verdict = json.at("verdict");
    for (const auto &[end, begins] :
         {std::make_pair(RunEnd::stopped, std::string(stopped)),
          std::make_pair(RunEnd::failed, std::string(failed))})
      if (verdict.rfind(begins, 0) == 0)
        {
          summary.end    = end;
          summary.reason = verdict.substr(begins.size());
        }
    nlohmann::json left = json;
    take(json, "version", summary.model, left);
    take(json, "time step [s]", summary.step, left);
    take(json, "steps", summary.march, left);
    summary.warnings = json.value("warnings", summary.warnings);
    summary.missing_files =
      json.value("files not written", summary.missing_files);
    for (const auto &[name, table] : tables_of(summary))
      if (json.contains(name))
        {
          *table = json.at(name);
          left.erase(name);
        }
    for (const char *name : {"verdict", "warnings", "files not written"})
      left.erase(name);
    summary.observers = left;
  }


  bool
  is_summary(const nlohmann::json &json)
  {
    return json.is_object() && json.contains("verdict") &&
           json.at("verdict").is_string();
  }


  void
  write_summary(const std::string &folder, RunSummary &summary, Log &log)
  {
    summary.warnings      = log.warnings();
    summary.missing_files = log.missing_files();
    if (Utilities::MPI::this_mpi_process(log.communicator()) != 0)
      return;
    const std::string name = folder + "/summary.json";
    log.attempted(name,
                  write_file(name, nlohmann::json(summary).dump(2) + '\n'));
  }


  StoppedRun::StoppedRun(const std::string &what, const RunSummary &summary)
    : RunStopped(what)
    , summary(summary)
  {}


  namespace
  {
    std::optional<TargetSpectrum>
    target_spectrum(const GroundMotion &motion)
    {
      if (motion.type != GroundMotionType::spectrum && !motion.match.wanted())
        return {};
      constexpr double shortest = 0.03, longest = 4.;
      TargetSpectrum   target{motion.spectrum.damping_ratio,
                            logarithmic_grid(shortest, longest, 50),
                            {}};
      for (unsigned int d = 0; d < 3; ++d)
        if (const double peak = motion.peak_acceleration(d).value_or(0.);
            peak > 0.)
          for (const double period : target.periods)
            {
              auto &component = target.components[d];
              if (!component)
                component.emplace();
              component->push_back(
                motion.overload_factor * standard_gravity * peak *
                motion.spectrum.target(d).amplification(period));
            }
      return target;
    }


    std::map<std::string, FitSummary>
    summary_of(const std::vector<SpectrumFit> &fits)
    {
      std::map<std::string, FitSummary> result;
      for (const SpectrumFit &fit : fits)
        {
          const auto [largest, at]                     = fit.largest_misfit();
          result[std::string(1, "xyz"[fit.component])] = {100. *
                                                            fit.mean_misfit(),
                                                          100. * largest,
                                                          at,
                                                          fit.factor,
                                                          fit.arias_before,
                                                          fit.arias_after};
        }
      return result;
    }


    std::optional<WaterSummary>
    summary_of(const WaterMotion *water, const MPI_Comm communicator)
    {
      if (water == nullptr)
        return {};
      return WaterSummary{water->reservoir.space.dof_handler.n_dofs(),
                          water->stored_energy(),
                          Utilities::MPI::sum(water->loss, communicator)};
    }


    nlohmann::json
    summary_of(const std::vector<PartitionCounts> &partitions)
    {
      nlohmann::json list;
      for (const PartitionCounts &counts : partitions)
        list.push_back({{"load over the mean", counts.load},
                        {"neighbours", counts.neighbours},
                        {"nodes exchanged", counts.nodes},
                        {"part of cells without these", counts.inner}});
      return list;
    }
  } // namespace


  std::map<std::string, CellQuality>
  worst_cells(const Model &model)
  {
    const MPI_Comm                 communicator = model.grid.communicator();
    const std::vector<std::string> names = model.parameters.material_names();
    std::vector<MeshQuality>       qualities(names.size());
    for (const auto &cell : model.grid.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          std::array<Point<3>, 8> vertices;
          for (const unsigned int v : cell->vertex_indices())
            vertices[v] = cell->vertex(v);
          qualities[model.solid.grid().material(cell)].take(vertices);
        }
    std::map<std::string, CellQuality> result;
    for (unsigned int i = 0; i < names.size(); ++i)
      result[names[i]] = {
        Utilities::MPI::min(qualities[i].scaled_jacobian, communicator),
        Utilities::MPI::max(qualities[i].aspect_ratio, communicator),
        Utilities::MPI::min(qualities[i].smallest_angle, communicator)};
    return result;
  }


  ModelSummary
  summary_of(const Model &model)
  {
    const MPI_Comm communicator = model.grid.communicator();
    return {version(),
            model.parameters.title,
            static_cast<unsigned int>(64 * Lanes::size()),
            Utilities::MPI::n_mpi_processes(communicator),
            model.grid.triangulation().n_global_active_cells(),
            model.solid.discretization.dof_handler.n_dofs(),
            model.solid.discretization.degree,
            worst_cells(model),
            largest_memory(communicator),
            ResultNames(model.parameters.material_names(),
                        model.grid,
                        model.contact.get())
              .json(),
            summary_of_refinement(model.parameters, model.grid.refinement()),
            summary_of(model.grid.partition_counts())};
  }


  StepSummary
  summary_of(const RunSetup &setup)
  {
    const Damping &damping = setup.damping;
    DampingSummary of_damping{option_name(setup.model.parameters.damping.model),
                              {},
                              {}};
    if (damping.n_branches() > 0)
      {
        of_damping.reference_frequency = damping.reference_frequency();
        of_damping.modulus_at_rest     = damping.modulus(0.);
      }
    return {setup.time_step.length, setup.time_step.limit, of_damping};
  }


  namespace
  {
    // None on one rank, or before the first step.
    std::optional<double>
    balance_of_cells(const CentralDifference &scheme,
                     const MPI_Comm           communicator)
    {
      const auto times =
        Utilities::MPI::min_max_avg(scheme.seconds_of_cells(), communicator);
      if (times.avg == 0. || Utilities::MPI::n_mpi_processes(communicator) == 1)
        return {};
      return times.max / times.avg;
    }
  } // namespace


  RunSummary
  summary_of(const Run &run)
  {
    const MPI_Comm communicator = run.log.communicator();
    RunSummary     summary;
    summary.model       = summary_of(run.model);
    summary.step        = summary_of(*run.setup);
    MarchSummary &march = summary.march.emplace();
    march.n_steps       = run.state.step;
    march.end_time      = run.state.time;
    march.loop_time     = run.times.seconds();
    march.throughput    = run.times.throughput(run.state.step);
    // least over the ranks: the last rank to reach the exchange of contact does
    // not wait there
    if (run.contact && march.loop_time > 0.)
      march.contact_share =
        Utilities::MPI::min(run.contact->seconds(), communicator) /
        march.loop_time;
    march.balance         = balance_of_cells(run.scheme, communicator);
    march.target_spectrum = target_spectrum(run.model.parameters.ground_motion);
    march.fits            = summary_of(run.setup->plan.motion.fits);
    march.static_state    = run.static_state.summary;
    if (!run.modes.list.empty())
      march.modes = run.modes.summary();
    march.reservoir = summary_of(run.setup->water.get(), communicator);
    if (run.model.solid.internal_force.has_memory())
      march.materials =
        memory_summary(run.observed, run.model.parameters.material_names());
    const auto &materials = run.model.solid.materials;
    if (std::any_of(materials.begin(),
                    materials.end(),
                    [](const Material *material) {
                      return reports_cracks(*material);
                    }))
      {
        const WidestCrack widest = widest_crack(run.observed, true);
        march.detachment         = {{"crack over its cell", widest.share},
                                    {"crack opening [mm]", 1e3 * widest.opening}};
        if (widest.opening > 0.)
          march.detachment["at [m]"] = to_json(widest.where);
      }
    march.energy = run.energy.summary();
    return summary;
  }


  std::string
  conclusion(const Run &run, const RunSummary &summary)
  {
    std::ostringstream text;
    text << std::setprecision(3)
         << (summary.missing_files.empty() ?
               "Done: " :
               "Done, but some results are not written: ")
         << run.times.n_steps(run.state.step) << " steps in "
         << duration_text(summary.march->loop_time) << ", "
         << summary.march->throughput
         << " MDOF-steps/s, energy-balance error at the end "
         << 100. * summary.march->energy.error_of_input << " %\n";
    if (run.contact)
      text << "Contact: " << 100. * summary.march->contact_share.value_or(0.)
           << " % of the loop, " << run.contact->effort().paths
           << " clusters by path following\n";
    if (summary.march->balance)
      text << "Time of the cells: largest " << *summary.march->balance
           << " of the mean of the ranks\n";
    for (const auto &[name, material] : summary.march->materials.items())
      if (const char *cells = "cells at tips of cracks and notches";
          material.contains(cells))
        text << "Material " << name << ": "
             << material.at(cells).get<unsigned long long>() << ' ' << cells
             << " had a lower tensile strength\n";
    for (const auto &[name, table] : tables_of(summary))
      text << description(name, *table);
    text << "Verdict: " << summary.verdict() << '\n';
    for (const std::string &warning : summary.warnings)
      text << "Warning: " << warning << '\n';
    return text.str();
  }
} // namespace Voussoir
