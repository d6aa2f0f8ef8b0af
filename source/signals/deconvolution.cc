#include <voussoir/signals/deconvolution.h>
#include <voussoir/signals/fourier.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  namespace
  {
    /** The largest |value|^2. */
    double
    largest_norm(const std::vector<std::complex<double>> &values)
    {
      double largest = 0;
      for (const std::complex<double> &value : values)
        largest = std::max(largest, std::norm(value));
      return largest;
    }

    /**
     * numerator / denominator, which tends to zero where |denominator| falls
     * below @p floor times its maximum (Tikhonov).
     */
    std::vector<std::complex<double>>
    regularized_quotient(const std::vector<std::complex<double>> &numerator,
                         const std::vector<std::complex<double>> &denominator,
                         const double                             floor)
    {
      const double shift = floor * floor * largest_norm(denominator);

      std::vector<std::complex<double>> quotient(numerator.size());
      for (std::size_t k = 0; k < quotient.size(); ++k)
        quotient[k] = numerator[k] * std::conj(denominator[k]) /
                      (std::norm(denominator[k]) + shift);
      return quotient;
    }

    /** Taper: 1 up to 0.8 of the maximum frequency, then half a cosine to 0. */
    double
    low_pass(const double frequency, const double maximum_frequency)
    {
      const double ratio = frequency / maximum_frequency;
      if (ratio <= .8)
        return 1.;
      if (ratio >= 1.)
        return 0.;
      return .5 + .5 * std::cos(dealii::numbers::PI * (ratio - .8) / .2);
    }
  } // namespace


  std::vector<double>
  deconvolve(const TimeSeries &response,
             const TimeSeries &excitation,
             const TimeSeries &target,
             const double      maximum_frequency)
  {
    const double dt = target.time_step;
    AssertThrow(std::abs(response.time_step - dt) < 1e-9 * dt &&
                  std::abs(excitation.time_step - dt) < 1e-9 * dt,
                dealii::ExcMessage("The time steps of the series differ."));

    // Twice the longest series, so that nothing wraps around into the result.
    const std::size_t size =
      transform_size(2 * std::max({response.values.size(),
                                   excitation.values.size(),
                                   target.values.size()}));

    const auto r = fourier_transform(response.values, size);
    const auto e = fourier_transform(excitation.values, size);
    AssertThrow(largest_norm(r) > 0 && largest_norm(e) > 0,
                dealii::ExcMessage("The system's response is zero."));

    // The first floor only guards against rounding errors where the excitation
    // ends, the second one against notches of the system.
    const auto transfer = regularized_quotient(r, e, 1e-7);
    auto input = regularized_quotient(fourier_transform(target.values, size),
                                      transfer,
                                      1e-3);
    for (std::size_t k = 0; k < input.size(); ++k)
      input[k] *= low_pass(k / (size * dt), maximum_frequency);

    std::vector<double> values = inverse_fourier_transform(std::move(input));
    values.resize(target.values.size());
    return values;
  }
} // namespace Voussoir
