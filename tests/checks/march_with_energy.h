#ifndef voussoir_tests_march_with_energy_h
#define voussoir_tests_march_with_energy_h

#include "check.h"

namespace Voussoir
{
  /** Integrates to the end time and evaluates the balance when due;
   *  callback(evaluated) is called after each step. */
  template <typename Callback>
  void
  march_with_energy(Run &run, const Callback &callback)
  {
    while (run.state.step < run.n_steps())
      {
        const bool evaluated = run.energy.is_due(run.state.step + 1) ||
                               run.state.step + 1 == run.n_steps();
        if (evaluated)
          run.energy.before_step(run.state);
        run.scheme.step(run.state);
        if (evaluated)
          run.energy.evaluate(run.state);
        callback(evaluated);
      }
  }
} // namespace Voussoir

#endif
