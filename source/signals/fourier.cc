#include <voussoir/signals/fourier.h>

#include <fftw3.h>

#include <algorithm>
#include <numeric>

namespace Voussoir
{
  namespace
  {
    /** std::complex and fftw_complex share their layout by specification. */
    fftw_complex *
    raw(std::vector<std::complex<double>> &values)
    {
      return reinterpret_cast<fftw_complex *>(values.data());
    }

    void
    execute(const fftw_plan plan)
    {
      fftw_execute(plan);
      fftw_destroy_plan(plan);
    }
  } // namespace


  std::vector<std::complex<double>>
  fourier_transform(const std::vector<double> &values, const std::size_t size)
  {
    std::vector<double> padded(size);
    std::copy_n(values.begin(), std::min(values.size(), size), padded.begin());

    // An estimated plan neither touches the data nor depends on timings, so
    // the same input gives the same bits.
    std::vector<std::complex<double>> spectrum(size / 2 + 1);
    execute(
      fftw_plan_dft_r2c_1d(size, padded.data(), raw(spectrum), FFTW_ESTIMATE));
    return spectrum;
  }


  std::vector<double>
  inverse_fourier_transform(std::vector<std::complex<double>> spectrum)
  {
    const std::size_t   size = 2 * (spectrum.size() - 1);
    std::vector<double> values(size);
    execute(
      fftw_plan_dft_c2r_1d(size, raw(spectrum), values.data(), FFTW_ESTIMATE));
    for (double &value : values)
      value /= size;
    return values;
  }


  std::size_t
  transform_size(const std::size_t size)
  {
    std::size_t result = 2;
    while (result < size)
      result *= 2;
    return result;
  }


  double
  frequency_of_intensity(
    const std::array<std::vector<double>, 3> &accelerations,
    const double                              sample_interval,
    const double                              share)
  {
    std::size_t n = 0;
    for (const auto &component : accelerations)
      n = std::max(n, component.size());
    const std::size_t   size = transform_size(n);
    std::vector<double> power(size / 2 + 1);
    for (const auto &component : accelerations)
      if (!component.empty())
        {
          const auto spectrum = fourier_transform(component, size);
          for (std::size_t k = 0; k < power.size(); ++k)
            power[k] += std::norm(spectrum[k]);
        }
    const double whole = std::accumulate(power.begin(), power.end(), 0.);
    double       sum   = 0.;
    for (std::size_t k = 0; k < power.size() && whole > 0.; ++k)
      if ((sum += power[k]) >= share * whole)
        return double(k) / (double(size) * sample_interval);
    return 0.;
  }
} // namespace Voussoir
