#ifndef voussoir_signals_response_spectrum_h
#define voussoir_signals_response_spectrum_h

#include <voussoir/signals/time_series.h>

namespace Voussoir
{
  /** Largest responses of single-degree-of-freedom oscillators to a motion. */
  struct ResponseSpectrum
  {
    /** Natural periods [s]; a period of 0 is a rigid oscillator. */
    std::vector<double> periods;

    /** Largest displacement relative to the ground [m]. */
    std::vector<double> displacement;

    /** (2 pi / period)^2 times the displacement [m/s2]. */
    std::vector<double> pseudo_acceleration;
  };

  /** The largest displacement relative to the ground, with its sign [m], and
   *  its time [s]. */
  struct PeakResponse
  {
    double displacement = 0., time = 0.;
  };

  /** Peak response of the oscillator of a natural period [s], computed as by
   *  response_spectrum(). */
  PeakResponse
  peak_response(const TimeSeries &acceleration,
                const double      period,
                const double      damping_ratio);

  /**
   * The response spectrum of a ground acceleration [m/s2] for oscillators of a
   * damping ratio below one, by the solution that is exact for an acceleration
   * linear between its samples (Nigam and Jennings 1969). Peaks are found
   * at least forty times in a period and until one period after the end.
   */
  ResponseSpectrum
  response_spectrum(const TimeSeries          &acceleration,
                    const std::vector<double> &periods,
                    const double               damping_ratio);

  /** @p number of values from @p first to @p last at constant ratio. */
  std::vector<double>
  logarithmic_grid(const double       first,
                   const double       last,
                   const unsigned int number);
} // namespace Voussoir

#endif
