#ifndef voussoir_signals_spectrum_motion_h
#define voussoir_signals_spectrum_motion_h

#include <voussoir/signals/design_spectrum.h>
#include <voussoir/signals/time_series.h>

#include <deal.II/base/parameter_handler.h>

#include <array>

namespace Voussoir
{
  /**
   * Artificial ground motions whose response spectra follow a design spectrum:
   * three components from independent random numbers.
   */
  struct SpectrumMotion
  {
    DesignSpectrum spectrum, vertical{SpectrumShape::as_horizontal};

    /** The design spectrum of a component. */
    const DesignSpectrum &
    target(const unsigned int component) const;

    double damping_ratio = 0.05;

    /** [s] */
    double duration  = 20.;
    double time_step = 0.01;

    /** Intensity over time: quadratic rise [s], plateau [s], decay [1/s]. */
    double rise_time        = 2.;
    double plateau_duration = 8.;
    double decay_rate       = 0.3;

    unsigned int seed = 1;

    /** Largest mean deviation from the design spectrum that is accepted [-]. */
    double tolerance = 0.05;

    void
    declare(dealii::ParameterHandler &prm);

    void
    check() const;

    /**
     * Three accelerations of unit peak [-] that bring the ground back to rest
     * where it was; the random numbers are the same with any standard library.
     * Throws UserError if the design spectrum is not met within the tolerance,
     * or if no three motions with a correlation below 0.1 are found.
     */
    std::array<TimeSeries, 3>
    generate() const;

    /**
     * The mean of |spectrum / design spectrum - 1| over natural periods from
     * 0.05 to 2 s for an acceleration of given peak.
     */
    double
    mean_deviation(const TimeSeries     &acceleration,
                   const double          peak_acceleration,
                   const DesignSpectrum &target) const;
  };

  /**
   * The correlation coefficient of two series, over the length of the shorter.
   */
  double
  correlation(const std::vector<double> &a, const std::vector<double> &b);
} // namespace Voussoir

#endif
