#include <voussoir/base/error.h>
#include <voussoir/signals/design_spectrum.h>

#include <deal.II/base/patterns.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace Voussoir
{
  void
  DesignSpectrum::declare(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    std::vector<SpectrumShape> shapes{SpectrumShape::hydropower_code,
                                      SpectrumShape::table};
    const bool is_vertical = shape == SpectrumShape::as_horizontal;
    if (is_vertical)
      shapes.push_back(SpectrumShape::as_horizontal);
    add_option(prm,
               "Shape",
               shape,
               std::string(
                 "hydropower code: the standard design spectrum of the Chinese "
                 "codes NB 35047 and GB 51247, which rises to a plateau from "
                 "0.1 s to the characteristic period and then decays; compare "
                 "it and the default values with the printed code, from which "
                 "they were not taken. table: the entries Periods and "
                 "Amplifications.") +
                 (is_vertical ? " as horizontal: that of the other components; "
                                "the entries below are not used." :
                                ""),
               shapes);
    prm.add_parameter(
      "Maximum amplification",
      maximum_amplification,
      "Spectral acceleration on the plateau of the code's spectrum over peak "
      "ground acceleration [-]; 2.5 for arch dams, 2.0 for gravity dams.",
      Double(1., 10.));
    prm.add_parameter("Characteristic period",
                      characteristic_period,
                      "End of the plateau of the code's spectrum [s]; 0.2 to "
                      "0.3 on rock.",
                      Double(0.1, 2.));
    prm.add_parameter(
      "Decay exponent",
      decay_exponent,
      "Exponent of the decay of the code's spectrum, period to minus this "
      "power [-].",
      Double(0., 2.));
    prm.add_parameter("Periods",
                      periods,
                      "Natural periods of the table [s], increasing.",
                      List(Double(0.), 2));
    prm.add_parameter(
      "Amplifications",
      amplifications,
      "Spectral acceleration of the table at these periods over peak ground "
      "acceleration [-]; linear in between, constant outside.",
      List(Double(1e-3), 2));
  }


  void
  DesignSpectrum::check(const std::string &place) const
  {
    if (shape != SpectrumShape::table)
      return;
    if (periods.size() != amplifications.size())
      throw UserError("\"Periods\" in section \"" + place + "\" has " +
                      std::to_string(periods.size()) +
                      " values and \"Amplifications\" has " +
                      std::to_string(amplifications.size()) +
                      "; give one amplification for each period.");
    if (std::adjacent_find(periods.begin(),
                           periods.end(),
                           std::greater_equal<double>()) != periods.end())
      throw UserError(
        "\"Periods\" in section \"" + place +
        "\" must increase from each value to the next; sort them and "
        "remove repeated ones.");
  }


  double
  DesignSpectrum::amplification(const double period) const
  {
    if (shape == SpectrumShape::table)
      return interpolate(periods, amplifications, period);

    // Rise to the plateau at 0.1 s; never below a fifth of the plateau.
    if (period < 0.1)
      return 1. + (maximum_amplification - 1.) * period / 0.1;
    if (period <= characteristic_period)
      return maximum_amplification;
    return maximum_amplification *
           std::max(0.2,
                    std::pow(characteristic_period / period, decay_exponent));
  }


  double
  interpolate(const std::vector<double> &x,
              const std::vector<double> &y,
              const double               at)
  {
    const auto upper = std::upper_bound(x.begin(), x.end(), at);
    if (upper == x.begin())
      return y.front();
    if (upper == x.end())
      return y.back();
    const std::size_t i      = upper - x.begin();
    const double      weight = (at - x[i - 1]) / (x[i] - x[i - 1]);
    return y[i - 1] + weight * (y[i] - y[i - 1]);
  }
} // namespace Voussoir
