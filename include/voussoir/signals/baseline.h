#ifndef voussoir_signals_baseline_h
#define voussoir_signals_baseline_h

#include <voussoir/base/option.h>
#include <voussoir/signals/time_series.h>

#include <deal.II/base/parameter_handler.h>

namespace Voussoir
{
  enum class BaselineMethod
  {
    none,
    polynomial,
    high_pass
  };

  inline OptionNames<BaselineMethod>
  option_names(const BaselineMethod)
  {
    return {{BaselineMethod::none, "none"},
            {BaselineMethod::polynomial, "polynomial"},
            {BaselineMethod::high_pass, "high-pass"}};
  }


  /**
   * Baseline correction of an acceleration, so that the motion starts and ends
   * at rest in its first position; the method none changes nothing. The
   * equations are in baseline.cc.
   */
  struct BaselineCorrection
  {
    BaselineMethod method = BaselineMethod::polynomial;

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
