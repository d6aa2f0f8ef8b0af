#ifndef voussoir_driver_run_summary_h
#define voussoir_driver_run_summary_h

#include <voussoir/base/error.h>
#include <voussoir/driver/run_setup.h>
#include <voussoir/output/energy.h>

#include <map>

namespace Voussoir
{
  /** Shape of the worst cells of a material. */
  struct CellQuality
  {
    double scaled_jacobian, aspect_ratio, smallest_angle; // [degrees]
  };

  /** Size of a run: program, ranks, mesh. */
  struct ModelSummary
  {
    std::string                        version, title;
    unsigned int                       simd_bits, n_ranks;
    unsigned long long                 n_cells, n_unknowns;
    unsigned int                       degree;
    std::map<std::string, CellQuality> mesh_quality; // by material
    double                             peak_memory;  // of a rank [MB]
    nlohmann::json                     names;        // see ResultNames
    nlohmann::json                     refinement; // where cracks are expected
    nlohmann::json                     partitions; // counted, see Grid
  };

  struct DampingSummary
  {
    std::string           model;
    std::optional<double> reference_frequency; // of the moduli [Hz]
    std::optional<double> modulus_at_rest;     // over the given one
  };

  struct StepSummary
  {
    double         length, limit; // [s]
    DampingSummary damping;
  };

  /** Fit of a recorded component to its target spectrum. */
  struct FitSummary
  {
    double mean_misfit, largest_misfit; // [%]
    double period;                      // of the largest one [s]
    double factor;
    double arias_before, arias_after; // intensity [m/s]
  };

  /** The spectrum that an artificial or matched motion follows. */
  struct TargetSpectrum
  {
    double              damping_ratio;
    std::vector<double> periods; // [s]

    /** Spectra in x, y, z [m/s2]; none where the ground does not move. */
    std::array<std::optional<std::vector<double>>, 3> components;
  };

  struct WaterSummary
  {
    unsigned long long n_unknowns;
    double             stored, lost; // energy [J]
  };

  /** Results of the time steps. */
  struct MarchSummary
  {
    unsigned long long    n_steps;
    double                end_time, loop_time; // [s]
    double                throughput;          // [MDOF-steps/s]
    std::optional<double> contact_share;       // of the loop
    std::optional<double> balance; // time of cells, largest over mean of ranks
    std::optional<TargetSpectrum>     target_spectrum;
    std::map<std::string, FitSummary> fits; // by component
    nlohmann::json                    static_state, modes;
    std::optional<WaterSummary>       reservoir;
    nlohmann::json materials;  // results of their laws, by name
    nlohmann::json detachment; // the widest crack, over its cell
    EnergySummary  energy;
  };

  enum class RunEnd
  {
    complete,
    stopped, // see RunStopped
    failed   // by a mistake in its file, or its results are not written
  };

  /** Results of a run at its end. */
  struct RunSummary
  {
    RunEnd      end = RunEnd::complete;
    std::string reason; // of another end

    std::optional<ModelSummary> model; // none if it was not made
    std::optional<StepSummary>  step;  // none before its damping was known
    std::optional<MarchSummary> march; // none before its first step

    /** Results of observers, under the names that they gave them. */
    nlohmann::json observers = nlohmann::json::object();

    /** Tables of lines with "met", see verdict_tables.h and
     *  AcceptanceParameters; null: there is none. */
    nlohmann::json checks, results, acceptance;

    std::vector<std::string>           warnings;
    std::map<std::string, std::string> missing_files; // with the reason

    /** "stopped: ..." or "failed: ..."; else "not met: ..." or "to be judged:
     *  ..." with the names of these lines of the tables; else "with warnings,
     *  see there" or "no objection". */
    std::string
    verdict() const;

    /** The verdict without the advice at its end. */
    std::string
    short_verdict() const;

    /** Makes the tables of results and acceptance from the rest. */
    void
    judge(const AcceptanceParameters &acceptance);
  };

  /** The contents of summary.json, which are written and read here alone. A
   *  study reads the summaries of earlier runs. */
  void
  to_json(nlohmann::json &json, const RunSummary &summary);

  void
  from_json(const nlohmann::json &json, RunSummary &summary);

  /** Whether a JSON may be a summary, by its verdict. */
  bool
  is_summary(const nlohmann::json &json);

  /** Adds warnings and missing files of the log, and writes summary.json into a
   *  folder. Called on all ranks. */
  void
  write_summary(const std::string &folder, RunSummary &summary, Log &log);

  /** A run that was stopped, with its results until then. */
  class StoppedRun : public RunStopped
  {
  public:
    StoppedRun(const std::string &what, const RunSummary &summary);

    const RunSummary summary;
  };

  /** Called on all ranks, by the names of the materials. */
  std::map<std::string, CellQuality>
  worst_cells(const Model &model);

  /** Called on all ranks. */
  ModelSummary
  summary_of(const Model &model);

  StepSummary
  summary_of(const RunSetup &setup);

  class Run;

  /** Results of a run so far, without its observers; called on all ranks. */
  RunSummary
  summary_of(const Run &run);

  /** The conclusion of a run for the log. */
  std::string
  conclusion(const Run &run, const RunSummary &summary);
} // namespace Voussoir

#endif
