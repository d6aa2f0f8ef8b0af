#ifndef voussoir_signals_time_series_h
#define voussoir_signals_time_series_h

#include <vector>

namespace Voussoir
{
  /** Samples at constant time step, the first one at t = 0. */
  struct TimeSeries
  {
    /** [s] */
    double time_step = 0;

    std::vector<double> values;
  };

  /** Acceleration with the velocity and displacement that belong to it. */
  struct Motion
  {
    /** [s] */
    double time_step = 0;

    /** Equally long, in m/s2, m/s and m. */
    std::vector<double> acceleration, velocity, displacement;
  };

  /**
   * The motion from rest under an acceleration [m/s2] that is linear between
   * its samples; velocity and displacement are the exact integrals.
   */
  Motion
  integrate(const TimeSeries &acceleration);

  /** The largest absolute value; 0 without values. */
  double
  peak(const std::vector<double> &values);

  /**
   * The part of a series from @p start on, at most @p duration long [s]; a
   * duration of 0 keeps everything to the end. Fewer than two samples remain
   * if @p start lies at or behind the end.
   */
  TimeSeries
  time_window(const TimeSeries &series,
              const double      start,
              const double      duration);
} // namespace Voussoir

#endif
