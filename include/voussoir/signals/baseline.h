#ifndef voussoir_signals_baseline_h
#define voussoir_signals_baseline_h

#include <voussoir/signals/time_series.h>

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace Voussoir
{
  /**
   * Baseline correction of an acceleration, so that the motion starts and ends
   * at rest in its first position; the method "none" leaves it as it is. The
   * equations are in baseline.cc.
   */
  struct BaselineCorrection
  {
    /** "none", "polynomial" or "high-pass". */
    std::string method = "polynomial";

    /** Of the high-pass filter [Hz]. */
    double corner_frequency = 0.1;

    /** Length of the tapers at both ends [s]. */
    double taper = 0.5;

    void
    declare(dealii::ParameterHandler &prm);

    /**
     * The corrected motion, as long as @p acceleration [m/s2]. Throws
     * UserError if the series is too short for the tapers.
     */
    Motion
    apply(const TimeSeries &acceleration) const;
  };
} // namespace Voussoir

#endif
