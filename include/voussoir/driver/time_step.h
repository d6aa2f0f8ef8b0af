#ifndef voussoir_driver_time_step_h
#define voussoir_driver_time_step_h

#include <voussoir/driver/model.h>

#include <optional>

namespace Voussoir
{
  /** The time step of a run, and what limits it. */
  struct TimeStep
  {
    /**
     * Finds the limits and chooses the step by the section "Time" of the case.
     * Throws UserError if the step that the case gives is above the limit.
     * Where materials have a memory the damping gets its mesh viscosity.
     *
     * @param internal_force that of the run, which the damping goes with
     * @param kept step of a checkpoint, which is taken instead [s]
     * @param interval of a record, of which the step becomes a whole part if it
     *   grows shorter by a tenth at most [s]; 0: none
     */
    TimeStep(const Model                 &model,
             const InternalForce         &internal_force,
             Damping                     &damping,
             const std::optional<double> &kept,
             const double                 interval,
             Log                         &log);

    /** Steps to this time [s]. */
    unsigned long long
    steps_to(const double time) const;

    double undamped_limit;         // [s], 0 where damping does not change it
    double closing_viscosity = 0.; // c of DampedResponse [s]
    double limit;                  // [s]
    double length;                 // [s]
    bool   central;                // see LeapFrog

    LeapFrog
    leap_frog() const
    {
      return {length, central};
    }
  };
} // namespace Voussoir

#endif
