#ifndef voussoir_signals_spectrum_match_h
#define voussoir_signals_spectrum_match_h

#include <voussoir/signals/design_spectrum.h>
#include <voussoir/signals/time_series.h>

#include <deal.II/base/parameter_handler.h>

#include <vector>

namespace Voussoir
{
  enum class MatchMethod
  {
    none,
    each_component,
    one_factor
  };

  inline OptionNames<MatchMethod>
  option_names(const MatchMethod)
  {
    return {{MatchMethod::none, "none"},
            {MatchMethod::each_component, "each component"},
            {MatchMethod::one_factor, "one factor"}};
  }


  /** Whether and how recorded motions are fitted to a target spectrum. */
  struct SpectrumMatch
  {
    MatchMethod method = MatchMethod::none;

    /** Periods at which the spectra are compared [s]. */
    double shortest_period = 0.03, longest_period = 5.;

    void
    declare(dealii::ParameterHandler &prm);

    /** Refuses a target that does not cover the periods; @p place names its
     *  section. */
    void
    check(const DesignSpectrum &target, const std::string &place) const;

    bool
    wanted() const;

    /** Periods at which the spectra are compared [s]; every other one is
     *  fitted. */
    std::vector<double>
    periods() const;
  };

  /** A component of a fitted motion. */
  struct SpectrumFit
  {
    unsigned int component = 0; // 0, 1, 2: x, y, z

    /** The fitted motion [m/s2]. */
    TimeSeries acceleration;

    /** Response spectra at natural periods [s], pseudo-acceleration: target,
     *  of the record times the factor, and of the fitted motion [m/s2]. */
    std::vector<double> periods, target, before, after;

    /** Factor on the record before its shape was changed. */
    double factor = 1.;

    /** Arias intensity of the record times the factor and of the fitted motion
     *  [m/s]. */
    double arias_before = 0., arias_after = 0.;

    /** Mean of |after / target - 1| over the periods. */
    double
    mean_misfit() const;

    /** The largest |after / target - 1|, and at which period [s]. */
    std::pair<double, double>
    largest_misfit() const;

    /** Multiplies motion and spectra by a factor. */
    void
    multiply(const double by);
  };

  /**
   * Fits recorded motions to target spectra: first all by one factor, or each
   * by a factor of its own, then, if each is to fit its own target, by wavelets
   * that are added at the times of the peak responses, which leave velocity and
   * displacement at rest in the end.
   *
   * @param records        of the components of @p fits [m/s2]
   * @param fits           with their components and targets at `periods`
   * @param damping_ratio  of the spectra [-]
   */
  void
  fit_to_spectrum(const std::vector<TimeSeries> &records,
                  const SpectrumMatch           &parameters,
                  const double                   damping_ratio,
                  std::vector<SpectrumFit>      &fits);

  /** Arias intensity of an acceleration [m/s2]: pi/(2 g) times the integral of
   *  its square [m/s]. */
  double
  arias_intensity(const TimeSeries &acceleration);
} // namespace Voussoir

#endif
