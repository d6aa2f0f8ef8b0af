#ifndef voussoir_fem_leap_frog_h
#define voussoir_fem_leap_frog_h

#include <voussoir/fem/damping.h>

#include <cmath>

namespace Voussoir
{
  /**
   * A step of central differences in leap-frog form,
   *   m (v+ - v-)/dt + c v = F ,   u_(n+1) = u_n + dt v+ ,
   * in which diagonal damping c acts on v = (v+ + v-)/2 if `central`, else, as
   * in TimeScheme::paper, on v = v- .
   */
  struct LeapFrog
  {
    double time_step; // dt [s]
    bool   central = true;

    /** The part of dt c that is added to the mass on the left-hand side. */
    double
    implicit_share() const
    {
      return central ? 0.5 * time_step : 0.;
    }

    /** The part of dt c that acts on v-. */
    double
    explicit_share() const
    {
      return central ? 0.5 * time_step : time_step;
    }

    /** The velocity v that damping acts on. */
    template <typename Velocity>
    Velocity
    damped(const Velocity &before, const Velocity &after) const
    {
      return central ? Velocity(0.5 * (before + after)) : before;
    }
  };


  /**
   * The Maxwell branches of the damping model over a step of constant velocity,
   * exactly: w <- decay w + gain v.
   */
  struct MaxwellStep
  {
    MaxwellStep(const Damping &damping, const double time_step)
    {
      for (unsigned int i = 0; i < damping.n_branches(); ++i)
        {
          const double tau = damping.relaxation_times[i];
          decay.push_back(std::exp(-time_step / tau));
          gain.push_back(damping.coefficients[i] * (1. - decay[i]) * tau);
        }
    }

    std::vector<double> decay, gain; // of each branch; gain in [s]
  };
} // namespace Voussoir

#endif
