#ifndef voussoir_signals_design_spectrum_h
#define voussoir_signals_design_spectrum_h

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace Voussoir
{
  /**
   * A design response spectrum: pseudo-acceleration divided by the peak ground
   * acceleration, over the natural period.
   */
  struct DesignSpectrum
  {
    /** "hydropower code" or "table". */
    std::string shape = "hydropower code";

    /** Of the code's shape: plateau [-], its end [s], exponent behind it. */
    double maximum_amplification = 2.5;
    double characteristic_period = 0.2;
    double decay_exponent        = 0.6;

    /** Of the table [s], [-]. */
    std::vector<double> periods        = {0., 0.1, 0.2, 2.};
    std::vector<double> amplifications = {1., 2.5, 2.5, 0.63};

    void
    declare(dealii::ParameterHandler &prm);

    /** Refuses a table with lists of different lengths or with periods that do
     *  not increase. */
    void
    check() const;

    /** The amplification at a natural period [s]. */
    double
    amplification(const double period) const;
  };

  /**
   * Linear interpolation in the table of the points (@p x, @p y), @p x
   * increasing; constant outside.
   */
  double
  interpolate(const std::vector<double> &x,
              const std::vector<double> &y,
              const double               at);
} // namespace Voussoir

#endif
