#ifndef voussoir_driver_time_step_h
#define voussoir_driver_time_step_h

#include <voussoir/driver/model.h>

#include <optional>

namespace Voussoir
{
  /** The largest stable step of the solid without damping and water [s]. */
  double
  undamped_step(const Model &model, const InternalForce &internal_force);

  /** The time step of a run, and its limits. */
  struct TimeStep
  {
    /**
     * Finds the limits and chooses the step by the section "Time" of the case.
     * Throws UserError if the step that the case gives is above the limit.
     *
     * @param internal_force that of the run, on which damping depends
     * @param undamped_limit undamped_step(), or 0 where damping does not change
     *   it
     * @param kept step of a checkpoint, which is taken instead [s]
     * @param interval of a record, of which the step becomes an integer
     * fraction if that shortens it by a tenth at most [s]; 0: none
     */
    TimeStep(const Model                 &model,
             const InternalForce         &internal_force,
             const Damping               &damping,
             const double                 undamped_limit,
             const std::optional<double> &kept,
             const double                 interval,
             Log                         &log);

    /** Number of steps to this time [s]. */
    unsigned long long
    steps_to(const double time) const;

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
