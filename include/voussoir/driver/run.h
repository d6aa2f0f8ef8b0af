#ifndef voussoir_driver_run_h
#define voussoir_driver_run_h

#include <voussoir/driver/run_checkpoints.h>
#include <voussoir/driver/run_requests.h>
#include <voussoir/driver/run_summary.h>
#include <voussoir/driver/run_times.h>
#include <voussoir/driver/static_state.h>
#include <voussoir/driver/supervision.h>
#include <voussoir/time/central_difference.h>

namespace Voussoir
{
  /**
   * One earthquake on a model: its state, its observers, and the time loop.
   * Everything that changes with time belongs to the run, so that another run
   * on the same model starts afresh.
   */
  class Run
  {
  public:
    /** @param model,static_state,modes,folder,log must live as long as this */
    Run(const Model        &model,
        const StaticState  &static_state,
        const Modes        &modes,
        const ResultFolder &folder,
        Log                &log);

    /** A run with a setup that was made before. */
    Run(const StaticState        &static_state,
        const Modes              &modes,
        const ResultFolder       &folder,
        std::unique_ptr<RunSetup> setup,
        Log                      &log);

    /** Steps to the end time: `begin`, each `step`, `end`. Throws StoppedRun if
     *  the energy balance is violated. */
    RunSummary
    march();

    /** Evaluation and output before the first step. */
    void
    begin();

    /** One step, with its observers. */
    void
    step();

    /** Writes the remaining results. Throws UserError if results could not be
     *  written.
     */
    RunSummary
    end();

    /** Steps to the end time, from t = 0. */
    unsigned long long
    n_steps() const;

    const std::unique_ptr<RunSetup> setup;
    const Model                    &model;
    const StaticState              &static_state;
    const Modes                    &modes;
    const ResultFolder             &folder;
    Log                            &log;
    const Damping                  &damping;
    const TimeStep                 &time_step;
    std::optional<Contact>          contact; // none without interfaces
    std::vector<ActingLoad>         loads;   // beside wave and water
    const CrackTips                 crack_tips;
    CrackPlanes                     crack_planes;
    const EquationOfMotion          equation;
    CentralDifference               scheme;
    State                           state;
    const ObservedRun               observed;
    EnergyBalance                   energy; // at the state
    RunTimes                        times;

  private:
    std::vector<NodalLoad *>
    nodal_loads();

    std::vector<Projection *>
    projections();

    /** Begins the files of the output folder. */
    void
    open_output();

    void
    observe();

    bool
    write_checkpoint();

    /** Polls the requests and fulfils them. */
    void
    poll_requests();

    [[noreturn]] void
    abort(const std::string &reason);

    Supervision    supervision;
    RunCheckpoints checkpoints;
    RunRequests    requests;
  };
} // namespace Voussoir

#endif
