#ifndef voussoir_tests_march_with_energy_h
#define voussoir_tests_march_with_energy_h

#include "check.h"

namespace Voussoir
{
  /** Marches to the end time and evaluates the balance at the case's interval;
   *  look(evaluated) is called after each step. */
  template <typename Look>
  void
  march_with_energy(const Case &parameters, Run &run, const Look &look)
  {
    const Schedule schedule(parameters.output.energy_interval,
                            run.time_step.length);
    while (run.state.time < parameters.time.end_time)
      {
        run.scheme.step(run.state);
        const bool evaluated = schedule.due(run.state.step) ||
                               run.state.time >= parameters.time.end_time;
        if (evaluated)
          run.energy.evaluate(run.state);
        look(evaluated);
      }
  }
} // namespace Voussoir

#endif
