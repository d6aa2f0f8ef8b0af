#ifndef voussoir_signals_design_spectrum_h
#define voussoir_signals_design_spectrum_h

#include <voussoir/base/option.h>

#include <deal.II/base/parameter_handler.h>

#include <vector>

namespace Voussoir
{
  enum class SpectrumShape
  {
    hydropower_code,
    table,
    as_horizontal // of a vertical spectrum
  };

  inline OptionNames<SpectrumShape>
  option_names(const SpectrumShape)
  {
    return {{SpectrumShape::hydropower_code, "hydropower code"},
            {SpectrumShape::table, "table"},
            {SpectrumShape::as_horizontal, "as horizontal"}};
  }


  /**
   * A design response spectrum: pseudo-acceleration divided by the peak ground
   * acceleration, over the natural period.
   */
  struct DesignSpectrum
  {
    SpectrumShape shape = SpectrumShape::hydropower_code;

    /** Of the code's shape: plateau [-], its end [s], exponent of the decay. */
    double maximum_amplification = 2.5;
    double characteristic_period = 0.2;
    double decay_exponent        = 0.6;

    /** Of the table [s], [-]. */
    std::vector<double> periods        = {0., 0.1, 0.2, 2.};
    std::vector<double> amplifications = {1., 2.5, 2.5, 0.63};

    /** Declares the entries, with the present shape as default. Only if that is
     *  `as_horizontal` is this shape an option. */
    void
    declare(dealii::ParameterHandler &prm);

    /** Refuses a table with lists of different lengths or with periods that do
     *  not increase; @p place names the section. */
    void
    check(const std::string &place) const;

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
