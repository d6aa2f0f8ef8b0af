#include <voussoir/base/error.h>
#include <voussoir/signals/baseline.h>
#include <voussoir/signals/fourier.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/patterns.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

// The correction removes from the tapered record w a the polynomial p of degree
// four, tapered likewise, that leaves the least displacement,
//
//   a_corrected = w (a - p),   w(0) = w(T) = 0,
//   integral of d_corrected^2 dt -> min  with  v(T) = 0, d(T) = 0.
//
// Velocity and displacement are linear in the coefficients of p; so this is a
// least-squares problem with two constraints, and both hold to round-off. PEER
// removes the same polynomial, of sixth degree in the displacement (Ancheta et
// al., PEER report 2013/03), without the end conditions. The high-pass
// filter that may precede it is the acausal four-pole Butterworth filter, with
// pads of zeros after Boore (Bull. Seism. Soc. Am. 95, 2005). The pads are cut
// off afterwards, their effect on the end of the motion is removed by p.

namespace Voussoir
{
  namespace
  {
    constexpr unsigned int n_coefficients = 5;

    /** The window w: half a cosine from 0 to 1 at either end. */
    std::vector<double>
    taper_window(const std::size_t size, const double n_taper)
    {
      std::vector<double> window(size);
      for (std::size_t i = 0; i < size; ++i)
        {
          const double distance = std::min(i, size - 1 - i);
          window[i] =
            distance < n_taper ?
              .5 - .5 * std::cos(dealii::numbers::PI * distance / n_taper) :
              1.;
        }
      return window;
    }

    /** The series w P_k of the Legendre polynomials P_k on [0, T]. */
    std::array<TimeSeries, n_coefficients>
    tapered_polynomials(const std::vector<double> &window,
                        const double               time_step)
    {
      const std::size_t                      size = window.size();
      std::array<TimeSeries, n_coefficients> series;
      series.fill({time_step, std::vector<double>(size)});
      for (std::size_t i = 0; i < size; ++i)
        {
          const double x = 2. * i / (size - 1.) - 1.;

          std::array<double, n_coefficients> legendre{{1., x}};
          for (unsigned int k = 2; k < n_coefficients; ++k)
            legendre[k] = ((2. * k - 1.) * x * legendre[k - 1] -
                           (k - 1.) * legendre[k - 2]) /
                          k;
          for (unsigned int k = 0; k < n_coefficients; ++k)
            series[k].values[i] = window[i] * legendre[k];
        }
      return series;
    }

    double
    dot(const std::vector<double> &a, const std::vector<double> &b)
    {
      return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
    }

    Motion
    remove_polynomial(TimeSeries acceleration, const double taper)
    {
      std::vector<double>      &a = acceleration.values;
      const std::vector<double> window =
        taper_window(a.size(), taper / acceleration.time_step);
      for (std::size_t i = 0; i < a.size(); ++i)
        a[i] *= window[i];

      const Motion tapered = integrate(acceleration);
      const auto   basis = tapered_polynomials(window, acceleration.time_step);
      std::array<Motion, n_coefficients> basis_motion;
      std::transform(basis.begin(),
                     basis.end(),
                     basis_motion.begin(),
                     integrate);

      // Normal equations bordered by the two constraints. They are in units of
      // the duration T, so that all entries are of similar size.
      const double               T  = acceleration.time_step * (a.size() - 1.);
      const double               T2 = T * T;
      constexpr unsigned int     n  = n_coefficients;
      dealii::FullMatrix<double> matrix(n + 2, n + 2);
      dealii::Vector<double>     right_hand_side(n + 2), solution(n + 2);
      for (unsigned int k = 0; k < n; ++k)
        {
          for (unsigned int l = 0; l < n; ++l)
            matrix(k, l) =
              dot(basis_motion[k].displacement, basis_motion[l].displacement) /
              (T2 * T2 * a.size());
          right_hand_side(k) =
            dot(basis_motion[k].displacement, tapered.displacement) /
            (T2 * T2 * a.size());
          matrix(k, n) = matrix(n, k) = basis_motion[k].velocity.back() / T;
          matrix(k, n + 1)            = matrix(n + 1, k) =
            basis_motion[k].displacement.back() / T2;
        }
      right_hand_side(n)     = tapered.velocity.back() / T;
      right_hand_side(n + 1) = tapered.displacement.back() / T2;

      matrix.gauss_jordan();
      matrix.vmult(solution, right_hand_side);

      for (unsigned int k = 0; k < n; ++k)
        for (std::size_t i = 0; i < a.size(); ++i)
          a[i] -= solution(k) * basis[k].values[i];
      return integrate(acceleration);
    }

    TimeSeries
    high_pass(const TimeSeries &acceleration, const double corner_frequency)
    {
      const double      dt   = acceleration.time_step;
      const std::size_t size = acceleration.values.size();

      // Boore's 1.5 n / f_c on either side with n = 4 poles.
      const std::size_t pads = std::ceil(2. * 6. / (corner_frequency * dt));
      const std::size_t padded_size = transform_size(size + pads);

      auto spectrum = fourier_transform(acceleration.values, padded_size);
      for (std::size_t k = 0; k < spectrum.size(); ++k)
        {
          const double ratio = k / (padded_size * dt) / corner_frequency;
          const double power = std::pow(ratio, 4);
          spectrum[k] *= power / (1. + power);
        }

      TimeSeries filtered{dt, inverse_fourier_transform(std::move(spectrum))};
      filtered.values.resize(size);
      return filtered;
    }
  } // namespace


  void
  BaselineCorrection::declare(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    add_option(
      prm,
      "Baseline correction",
      method,
      "Method that removes the drift of velocity and displacement due to small "
      "errors of the recorded acceleration. polynomial: a polynomial of fourth "
      "degree is subtracted from the acceleration, so that the motion ends at "
      "rest where it began. high-pass: as polynomial, after a Butterworth "
      "filter without phase shift. none: the record as it is.");
    prm.add_parameter("Corner frequency",
                      corner_frequency,
                      "Corner frequency of the high-pass filter [Hz].",
                      Double(0.01, 10.));
    prm.add_parameter("Taper",
                      taper,
                      "Time over which the acceleration rises from zero at the "
                      "start and falls to zero at the end, except with "
                      "Baseline correction = none [s].",
                      Double(0.));
  }


  Motion
  BaselineCorrection::apply(const TimeSeries &acceleration) const
  {
    if (method == BaselineMethod::none)
      return integrate(acceleration);

    const double duration =
      acceleration.time_step * (acceleration.values.size() - 1.);
    if (acceleration.values.size() < 20 || 2. * taper > duration)
      throw UserError(
        "\"Baseline correction\" in section \"Ground motion/Record\" needs a "
        "record of twenty samples that is longer than both tapers together, "
        "but this one lasts " +
        std::to_string(duration) +
        " s; shorten the \"Taper\", or set \"Baseline correction = none\".");

    return remove_polynomial(method == BaselineMethod::high_pass ?
                               high_pass(acceleration, corner_frequency) :
                               acceleration,
                             taper);
  }
} // namespace Voussoir
