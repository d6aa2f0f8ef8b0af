#ifndef voussoir_driver_run_times_h
#define voussoir_driver_run_times_h

#include <deal.II/base/timer.h>
#include <deal.II/base/types.h>

#include <string>

namespace Voussoir
{
  /** Wall times of a run. */
  class RunTimes
  {
  public:
    explicit RunTimes(const dealii::types::global_dof_index n_unknowns);

    /** To be called when the loop begins, after this step. */
    void
    start(const unsigned long long step);

    /** To be called when the loop has ended. */
    void
    stop();

    /** Duration of the loop, so far or until its end [s]. */
    double
    seconds() const;

    /** Number of steps of the loop up to this one. */
    unsigned long long
    n_steps(const unsigned long long step) const;

    /** [MDOF-steps/s] */
    double
    throughput(const unsigned long long step) const;

    /** "time left ...", at a step before the last one. */
    std::string
    time_left(const unsigned long long step,
              const unsigned long long last_step) const;

    /** Seconds and calls of the sections of the loop. */
    std::string
    table() const;

    dealii::TimerOutput sections;

  private:
    const double       n_unknowns;
    dealii::Timer      clock;
    unsigned long long first_step = 0;
  };
} // namespace Voussoir

#endif
