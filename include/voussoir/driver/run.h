#ifndef voussoir_driver_run_h
#define voussoir_driver_run_h

#include <voussoir/driver/earthquake.h>
#include <voussoir/driver/rest_state.h>
#include <voussoir/driver/result_folder.h>
#include <voussoir/loads/water_motion.h>
#include <voussoir/output/checkpoint.h>
#include <voussoir/output/energy.h>
#include <voussoir/time/central_difference.h>

#include <deal.II/base/timer.h>

namespace Voussoir
{
  /**
   * One earthquake on a model: what is marched, what watches it, and the time
   * loop. All that changes with time is its own, so that another run can be
   * made on the same model and starts clean.
   */
  class Run
  {
  public:
    /** @param model,rest,folder,log must live as long as this */
    Run(const Model        &model,
        const RestState    &rest,
        const Modes        &modes,
        const ResultFolder &folder,
        Log                &log);

    /** Steps to the end time. */
    void
    march();

    const Model                 &model;
    const RestState             &rest;
    const Modes                 &modes;
    const ResultFolder          &folder;
    Log                         &log;
    Damping                      damping;
    const TimeStep               time_step;
    Earthquake                   earthquake;
    std::unique_ptr<WaterMotion> water;   // compressible, or null
    std::optional<Contact>       contact; // none without interfaces
    const EquationOfMotion       equation;
    CentralDifference            scheme;
    State                        state;
    const ObservedModel          observed;

    /** Energy balance at the state. */
    EnergyBalance energy;

    nlohmann::json
    summary() const;

    /** Steps to the end time, from t = 0. */
    unsigned long long
    n_steps() const;

  private:
    std::vector<NodalLoad *>
    nodal_loads() const;

    std::vector<Projection *>
    projections();

    ObservedModel
    what_is_observed() const;

    /** Makes the output folder and its files. */
    void
    open_output();

    void
    write_modes() const;

    void
    observe();

    /** Evaluates the energy balance and stops a run that has gone wrong. */
    void
    check_energy();

    /** Warns of contact that was not solved. */
    void
    check_contact();

    /** Keeps what a picture of the last good state needs. */
    void
    keep_last_good();

    /** What the clock asks for: progress, checkpoint, stop on request. */
    void
    attend();

    void
    report_progress();

    /** [MDOF-steps/s] */
    double
    throughput(const double seconds) const;

    std::map<std::string, Vector *>
    checkpoint_vectors();

    std::map<std::string, KeyedValues>
    checkpoint_values();

    void
    write_checkpoint();

    void
    read_checkpoint();

    void
    finish();

    void
    write_summary(const nlohmann::json &result) const;

    std::string
    timer_table() const;

    [[noreturn]] void
    abort(const std::string &reason);

    Checkpoint          checkpoint;
    State               last_good; // displacement, velocity and time alone
    dealii::TimerOutput timer;
    dealii::Timer       clock, since_report, since_checkpoint;
    unsigned long long  first_step   = 0;
    double              loop_seconds = 0.;

    std::vector<std::string> warnings; // that the results need
  };
} // namespace Voussoir

#endif
