#ifndef voussoir_driver_run_h
#define voussoir_driver_run_h

#include <voussoir/driver/rest_state.h>
#include <voussoir/driver/run_setup.h>
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
    /** @param model,rest,modes,folder,log must live as long as this */
    Run(const Model        &model,
        const RestState    &rest,
        const Modes        &modes,
        const ResultFolder &folder,
        Log                &log);

    /** With what was made and checked before the static state was found. */
    Run(const RestState          &rest,
        const Modes              &modes,
        const ResultFolder       &folder,
        std::unique_ptr<RunSetup> setup,
        Log                      &log);

    /** Steps to the end time: `begin`, each `step`, `end`. */
    void
    march();

    /** What comes before the first step. */
    void
    begin();

    /** One step, with what watches it. */
    void
    step();

    /** Writes what is left. Throws UserError if results could not be written.
     */
    void
    end();

    const std::unique_ptr<RunSetup>     setup;
    const Model                        &model;
    const RestState                    &rest;
    const Modes                        &modes;
    const ResultFolder                 &folder;
    Log                                &log;
    const Damping                      &damping;
    const TimeStep                     &time_step;
    Earthquake                         &earthquake;
    const std::unique_ptr<WaterMotion> &water;   // compressible, or null
    std::optional<Contact>              contact; // none without interfaces
    std::vector<ActingLoad>             loads;   // beside wave and water
    const EquationOfMotion              equation;
    CentralDifference                   scheme;
    State                               state;
    const ObservedModel                 observed;

    /** Energy balance at the state. */
    EnergyBalance energy;

    nlohmann::json
    summary() const;

    /** Steps to the end time, from t = 0. */
    unsigned long long
    n_steps() const;

  private:
    std::vector<NodalLoad *>
    nodal_loads();

    std::vector<Projection *>
    projections();

    /** Begins the files of the output folder. */
    void
    open_output();

    void
    write_modes() const;

    /** Writes ground_motion.csv. */
    void
    write_ground_motion() const;

    void
    observe();

    /** Evaluates the energy balance and stops a run that has gone wrong. */
    void
    check_energy();

    /** Warns of cracks so wide that what they cut off moves on its own. */
    void
    check_cracks();

    /** Warns of slips so far that nodes no longer face those they act on. */
    void
    check_slips();

    /** Warns of contact that was not solved. */
    void
    check_contact();

    /** Keeps what a picture of the last good state needs. */
    void
    keep_last_good();

    /** What the clock and those outside ask for: progress, checkpoint, stop. */
    void
    attend();

    void
    report_progress();

    /** [MDOF-steps/s] */
    double
    throughput(const double seconds) const;

    std::vector<Sum *>
    sums_of_rank();

    std::vector<double *>
    plain_sums_of_rank();

    /** The live numbers that a checkpoint holds; documents are empty. */
    StateContent
    checkpoint_content();

    /** Of the files that grow, by name in the output folder [bytes]. */
    nlohmann::json
    sizes_of_files() const;

    /** @return whether it was possible */
    bool
    write_checkpoint();

    void
    read_checkpoint();

    void
    finish();

    /** Throws UserError if the results are not all written. */
    void
    refuse_missing_files() const;

    std::string
    timer_table() const;

    [[noreturn]] void
    abort(const std::string &reason);

    Checkpoint          checkpoint;
    State               last_good; // without the memory of materials
    Schedule            checkpoints, loose_checks;
    dealii::TimerOutput timer;
    dealii::Timer       clock, since_checkpoint, since_look, since_stop_file;
    unsigned long long  first_step = 0;
    unsigned long long  last_look = 0, next_look = 0; // steps of `attend`
    double              loop_seconds     = 0.;
    bool                warned_of_energy = false, warned_of_cracks = false,
         warned_of_slips = false;
  };
} // namespace Voussoir

#endif
