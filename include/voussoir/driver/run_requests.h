#ifndef voussoir_driver_run_requests_h
#define voussoir_driver_run_requests_h

#include <voussoir/driver/result_folder.h>

#include <deal.II/base/timer.h>

namespace Voussoir
{
  /** Requests to a run, by the clock, by signals and by a file "stop" in its
   *  folder. */
  class RunRequests
  {
  public:
    /** @param folder,log must live as long as this */
    RunRequests(const OutputParameters &parameters,
                const ResultFolder     &folder,
                Log                    &log);

    /** To be called when the loop begins, after this step. */
    void
    start(const unsigned long long step);

    /** Whether it is time to poll after a step. */
    bool
    are_due(const unsigned long long step) const;

    /** A report of progress, a checkpoint, an end after that. */
    struct Requests
    {
      bool report, save, stop;
    };

    /** Polls; the same on all ranks, which must call this together. */
    Requests
    poll(const unsigned long long step);

    /** To be called after each attempt to write a checkpoint. */
    void
    checkpoint_tried();

  private:
    const double        checkpoint_interval; // [s]; 0: none
    const ResultFolder &folder;
    Log                &log;
    dealii::Timer       since_checkpoint, since_poll, since_stop_file;
    unsigned long long  last_poll = 0, next_poll = 0; // steps
  };
} // namespace Voussoir

#endif
