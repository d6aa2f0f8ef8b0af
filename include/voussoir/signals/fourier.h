#ifndef voussoir_signals_fourier_h
#define voussoir_signals_fourier_h

#include <array>
#include <complex>
#include <vector>

namespace Voussoir
{
  /**
   * The discrete Fourier transform, sum over n of x_n exp(-2 pi i k n / N) for
   * k = 0 ... N/2, of @p values continued by zeros to the even length @p size.
   */
  std::vector<std::complex<double>>
  fourier_transform(const std::vector<double> &values, const std::size_t size);

  /**
   * Inverse of fourier_transform(): N real values from N/2 + 1 complex ones,
   * N even.
   */
  std::vector<double>
  inverse_fourier_transform(std::vector<std::complex<double>> spectrum);

  /** The smallest power of two not below @p size, at least two. */
  std::size_t
  transform_size(const std::size_t size);

  /** Frequency below which a share of the Arias intensity of these
   *  accelerations lies, of all components [Hz]; 0 if nothing moves. */
  double
  frequency_of_intensity(
    const std::array<std::vector<double>, 3> &accelerations,
    const double                              sample_interval,
    const double                              share);
} // namespace Voussoir

#endif
