#ifndef voussoir_signals_deconvolution_h
#define voussoir_signals_deconvolution_h

#include <voussoir/signals/time_series.h>

namespace Voussoir
{
  /**
   * The input that makes a linear system respond with @p target, when the
   * system is known by its @p response to one @p excitation:
   * input = target / H with H = response / excitation in the frequency domain.
   * The three series have one time step and any lengths; the result is as long
   * as the target and has the unit of the excitation times target / response.
   *
   * - The excitation must contain all frequencies up to
   *   @p maximum_frequency [Hz] and the response must have died out at its end.
   * - Higher frequencies are removed, with a cosine taper from 0.8 times
   *   @p maximum_frequency on; a maximum above the Nyquist frequency removes
   *   nothing.
   * - Where |H| falls below a thousandth of its maximum (a frequency the system
   *   does not respond to) the input tends to zero instead of to infinity.
   * - The input precedes its response by the travel time between the two
   * points: give the target at least that long a quiet start.
   *
   * @return input samples at the time step of the series
   */
  std::vector<double>
  deconvolve(const TimeSeries &response,
             const TimeSeries &excitation,
             const TimeSeries &target,
             const double      maximum_frequency);
} // namespace Voussoir

#endif
