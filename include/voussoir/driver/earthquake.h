#ifndef voussoir_driver_earthquake_h
#define voussoir_driver_earthquake_h

#include <voussoir/driver/time_step.h>
#include <voussoir/loads/ground_motion.h>
#include <voussoir/loads/incoming_wave.h>
#include <voussoir/loads/rigid_base.h>

namespace Voussoir
{
  /** The motion of the ground by the entries of a case. */
  struct EarthquakeMotion
  {
    /** Reads or makes the motion and reports it. Throws UserError for a motion
     *  that cannot enter the model in the given way. */
    EarthquakeMotion(const Model &model, Log &log);

    /** None where the ground does not move; moved into the Earthquake. */
    GroundMotionSignals signals;

    /** Accelerations up to the end time in x, y, z [m/s2], every
     *  `sample_interval` [s]; none where the ground does not move. */
    std::array<std::vector<double>, 3> accelerations;
    static constexpr double            sample_interval = 1e-3;

    /** Misfit of recorded components to their target spectrum. */
    std::vector<SpectrumFit> fits;

    /** Time up to which a motion without end was deconvolved from the free
     *  surface, on which the result depends a little [s]; 0 otherwise. */
    double followed_to = 0.;
  };

  /** The earthquake of a run: motion of a rigid base, or waves that enter the
   *  model. */
  struct Earthquake
  {
    Earthquake(const Model          &model,
               GroundMotionSignals &&motion,
               const Damping        &damping,
               const TimeStep       &time_step);

    /** The ground under the model, at rest unless it is a rigid base. */
    RigidBase base;

    /** The wave that enters through the absorbing boundary, or null. */
    std::unique_ptr<IncomingWave> wave;
  };
} // namespace Voussoir

#endif
