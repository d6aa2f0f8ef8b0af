#include <voussoir/base/error.h>
#include <voussoir/signals/baseline.h>
#include <voussoir/signals/record.h>
#include <voussoir/signals/response_spectrum.h>
#include <voussoir/signals/spectrum_match.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/patterns.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

// Method: wavelets of tapered cosine shape, one for each period at the time of
// its peak response, with the amplitudes that bring all peaks to the target at
// once (Lilhanand and Tseng 1988; wavelet and its width after Al Atik and
// Abrahamson, Earthquake Spectra 26, 2010). As peaks move, this is repeated.
// The wavelets have enough cycles to leave velocity and displacement at rest;
// parts before the start of the record are cut off, and the baseline correction
// compensates for this.

namespace Voussoir
{
  namespace
  {
    constexpr double       period_ratio = 1.05; // between fitted periods
    constexpr unsigned int n_matching_iterations = 15;

    // Share of the sum of squares that keeps amplitudes small where
    // neighbouring periods compete.
    constexpr double regularisation = 0.003;

    // A peak with a larger error is corrected in several iterations.
    constexpr double largest_correction = 0.6;


    /** The acceleration at steps that resolve the shortest period, linear
     *  between its samples as before. */
    TimeSeries
    refined(const TimeSeries &acceleration, const double shortest_period)
    {
      const unsigned int parts = std::max(
        1., std::ceil(10. * acceleration.time_step / shortest_period - 1e-9));
      const std::vector<double> &a = acceleration.values;
      TimeSeries fine{acceleration.time_step / parts, {a.front()}};
      for (std::size_t i = 1; i < a.size(); ++i)
        for (unsigned int j = 1; j <= parts; ++j)
          fine.values.push_back(a[i - 1] +
                                (a[i] - a[i - 1]) * j / double(parts));
      return fine;
    }


    /** An oscillator, its peak response, and the wavelet that corrects it. */
    class Wavelet
    {
    public:
      Wavelet(const double        period,
              const double        damping_ratio,
              const PeakResponse &peak)
        : peak(peak)
        , omega(2. * dealii::numbers::PI / period)
        , damping(damping_ratio)
        , damped_omega(omega * std::sqrt(1. - damping * damping))
        , middle(peak.time -
                 std::atan(std::sqrt(1. - damping * damping) / damping) /
                   damped_omega)
        , width(1.178 * std::pow(period, 0.93))
      {}

      double
      value(const double time) const
      {
        const double t = time - middle;
        return std::cos(damped_omega * t) * std::exp(-t * t / (width * width));
      }

      /** Displacement of the oscillator at the time of its peak due to an
       *  impulse of the ground at a time [s2]. */
      double
      impulse_response(const double time) const
      {
        const double t = peak.time - time;
        return t <= 0. ? 0. :
                         -std::exp(-damping * omega * t) *
                           std::sin(damped_omega * t) / damped_omega;
      }

      /** First and last sample of the wavelet in a series. */
      std::pair<std::size_t, std::size_t>
      samples(const TimeSeries &series) const
      {
        const auto number = [&](const double time) -> std::size_t {
          return std::clamp(std::round(time / series.time_step),
                            0.,
                            double(series.values.size()));
        };
        return {number(middle - 4. * width), number(middle + 4. * width)};
      }

      const PeakResponse peak;

    private:
      const double omega, damping, damped_omega, middle, width;
    };


    /** Adds the wavelets that bring the peak responses at @p periods to the
     *  @p target [m], to first order. */
    void
    add_wavelets(TimeSeries                &motion,
                 const std::vector<double> &periods,
                 const std::vector<double> &target,
                 const double               damping_ratio)
    {
      const std::size_t                n  = periods.size();
      const double                     dt = motion.time_step;
      std::vector<Wavelet>             wavelets;
      std::vector<std::vector<double>> shapes;
      for (const double period : periods)
        {
          wavelets.emplace_back(period,
                                damping_ratio,
                                peak_response(motion, period, damping_ratio));
          const auto [begin, end] = wavelets.back().samples(motion);
          shapes.emplace_back();
          for (std::size_t k = begin; k < end; ++k)
            shapes.back().push_back(wavelets.back().value(k * dt));
        }

      // of peak i due to wavelet j, over the target
      dealii::FullMatrix<double> matrix(n, n), normal(n, n);
      dealii::Vector<double>     missing(n), right(n), amplitudes(n);
      std::vector<double>        impulse(motion.values.size());
      for (std::size_t i = 0; i < n; ++i)
        {
          for (std::size_t k = 0; k < impulse.size(); ++k)
            impulse[k] = wavelets[i].impulse_response(k * dt) * dt / target[i];
          for (std::size_t j = 0; j < n; ++j)
            matrix(i, j) =
              std::inner_product(shapes[j].begin(),
                                 shapes[j].end(),
                                 impulse.begin() +
                                   wavelets[j].samples(motion).first,
                                 0.);
          const double peak = wavelets[i].peak.displacement;
          missing(i)        = std::copysign(1., peak) *
                       std::clamp(1. - std::abs(peak) / target[i],
                                  -largest_correction,
                                  largest_correction);
        }
      // in units in which each wavelet moves its own peak by the target
      std::vector<double> units;
      for (std::size_t j = 0; j < n; ++j)
        {
          units.push_back(1. / std::max(std::abs(matrix(j, j)), 1e-300));
          for (std::size_t i = 0; i < n; ++i)
            matrix(i, j) *= units[j];
        }
      matrix.Tmmult(normal, matrix);
      for (std::size_t i = 0; i < n; ++i)
        normal(i, i) += regularisation;
      matrix.Tvmult(right, missing);
      normal.gauss_jordan();
      normal.vmult(amplitudes, right);

      for (std::size_t j = 0; j < n; ++j)
        {
          const std::size_t begin = wavelets[j].samples(motion).first;
          for (std::size_t k = 0; k < shapes[j].size(); ++k)
            motion.values[begin + k] += amplitudes(j) * units[j] * shapes[j][k];
        }
    }


    /** The best of the iterates. */
    void
    change_shape(SpectrumFit &fit, const double damping_ratio)
    {
      // every other period is fitted, those between are checked
      std::vector<double> periods, target;
      for (std::size_t i = 0; i < fit.periods.size(); i += 2)
        {
          const double omega = 2. * dealii::numbers::PI / fit.periods[i];
          periods.push_back(fit.periods[i]);
          target.push_back(fit.target[i] / (omega * omega));
        }
      TimeSeries  motion = fit.acceleration;
      SpectrumFit best   = fit;
      double      least  = std::numeric_limits<double>::max();
      for (unsigned int i = 0; i < n_matching_iterations; ++i)
        {
          add_wavelets(motion, periods, target, damping_ratio);
          motion.values = BaselineCorrection().apply(motion).acceleration;
          fit.after     = response_spectrum(motion, fit.periods, damping_ratio)
                        .pseudo_acceleration;
          if (const double misfit =
                fit.largest_misfit().first + fit.mean_misfit();
              misfit < least)
            {
              least             = misfit;
              best              = fit;
              best.acceleration = motion;
            }
        }
      fit = best;
    }
  } // namespace


  void
  SpectrumMatch::declare(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    add_option(
      prm,
      "Method",
      method,
      "How records are fitted to a target spectrum, which is that of section "
      "\"Ground motion/Spectrum\" (Shape to Amplifications, Damping ratio) "
      "times the Peak acceleration of the component. each component: by "
      "wavelets at the times of the peak responses, after a factor. one "
      "factor: all components by the same factor, so that their shapes and "
      "ratios are kept. none: a record is scaled to the Peak acceleration "
      "only.");
    prm.add_parameter("Shortest period",
                      shortest_period,
                      "Shortest natural period whose response is fitted [s].",
                      Double(0.01));
    prm.add_parameter("Longest period",
                      longest_period,
                      "Longest natural period whose response is fitted [s].",
                      Double(0.01, 20.));
  }


  void
  SpectrumMatch::check(const DesignSpectrum &target,
                       const std::string    &place) const
  {
    if (longest_period < 1.1 * shortest_period)
      throw UserError("\"Longest period\" in section \"Ground "
                      "motion/Matching\" must be at least 1.1 times the "
                      "\"Shortest period\".");
    target.check(place);
    if (target.shape == SpectrumShape::table &&
        (target.periods.front() > shortest_period ||
         target.periods.back() < longest_period))
      {
        std::ostringstream text;
        text << "\"Periods\" in section \"" << place << "\" go from "
             << target.periods.front() << " to " << target.periods.back()
             << " s, but records are matched from " << shortest_period << " to "
             << longest_period
             << " s; give the target for all of them, or change \"Shortest "
                "period\" and \"Longest period\" in section \"Ground "
                "motion/Matching\".";
        throw UserError(text.str());
      }
  }


  bool
  SpectrumMatch::wanted() const
  {
    return method != MatchMethod::none;
  }


  std::vector<double>
  SpectrumMatch::periods() const
  {
    const unsigned int n_fitted =
      2 + std::log(longest_period / shortest_period) / std::log(period_ratio);
    return logarithmic_grid(shortest_period, longest_period, 2 * n_fitted - 1);
  }


  double
  SpectrumFit::mean_misfit() const
  {
    double sum = 0.;
    for (std::size_t i = 0; i < periods.size(); ++i)
      sum += std::abs(after[i] / target[i] - 1.);
    return sum / periods.size();
  }


  std::pair<double, double>
  SpectrumFit::largest_misfit() const
  {
    std::pair<double, double> largest(0., 0.);
    for (std::size_t i = 0; i < periods.size(); ++i)
      largest =
        std::max(largest, {std::abs(after[i] / target[i] - 1.), periods[i]});
    return largest;
  }


  namespace
  {
    void
    scale(std::vector<double> &values, const double factor)
    {
      for (double &value : values)
        value *= factor;
    }
  } // namespace


  void
  SpectrumFit::multiply(const double by)
  {
    for (std::vector<double> *values :
         {&acceleration.values, &target, &before, &after})
      scale(*values, by);
    factor *= by;
    arias_before *= by * by;
    arias_after *= by * by;
  }


  void
  fit_to_spectrum(const std::vector<TimeSeries> &records,
                  const SpectrumMatch           &parameters,
                  const double                   damping_ratio,
                  std::vector<SpectrumFit>      &fits)
  {
    double sum_of_all = 0.;
    for (std::size_t c = 0; c < fits.size(); ++c)
      {
        SpectrumFit &fit = fits[c];
        fit.acceleration = refined(records[c], parameters.shortest_period);
        fit.before =
          response_spectrum(fit.acceleration, fit.periods, damping_ratio)
            .pseudo_acceleration;
        double sum = 0.;
        for (std::size_t i = 0; i < fit.periods.size(); ++i)
          sum += std::log(fit.target[i] / fit.before[i]) / fit.periods.size();
        fit.factor = std::exp(sum);
        sum_of_all += sum / fits.size();
      }
    for (SpectrumFit &fit : fits)
      {
        if (parameters.method == MatchMethod::one_factor)
          fit.factor = std::exp(sum_of_all);
        scale(fit.acceleration.values, fit.factor);
        scale(fit.before, fit.factor);
        fit.after        = fit.before;
        fit.arias_before = arias_intensity(fit.acceleration);
        if (parameters.method == MatchMethod::each_component)
          change_shape(fit, damping_ratio);
        fit.arias_after = arias_intensity(fit.acceleration);
      }
  }


  double
  arias_intensity(const TimeSeries &acceleration)
  {
    // of a motion that is linear between the samples
    const std::vector<double> &a   = acceleration.values;
    double                     sum = 0.;
    for (std::size_t i = 1; i < a.size(); ++i)
      sum += (a[i - 1] * a[i - 1] + a[i - 1] * a[i] + a[i] * a[i]) / 3.;
    return dealii::numbers::PI / (2. * standard_gravity) * sum *
           acceleration.time_step;
  }
} // namespace Voussoir
