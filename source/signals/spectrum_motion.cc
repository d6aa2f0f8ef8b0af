#include <voussoir/base/error.h>
#include <voussoir/signals/baseline.h>
#include <voussoir/signals/fourier.h>
#include <voussoir/signals/response_spectrum.h>
#include <voussoir/signals/spectrum_motion.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/patterns.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

// Method (after Gasparini and Vanmarcke's SIMQKE, MIT 1976): a sum of cosines
// of random phase times the intensity envelope; the Fourier amplitudes are
// multiplied by target / obtained response spectrum until both agree.

namespace Voussoir
{
  namespace
  {
    constexpr double       shortest_period = 0.03;
    constexpr double       longest_period  = 3.;
    constexpr unsigned int n_iterations    = 15;

    /** Periods at which the spectrum is matched. */
    std::vector<double>
    matched_periods()
    {
      return logarithmic_grid(shortest_period, longest_period, 100);
    }

    /**
     * A uniform number in [0, 1): the upper 53 bits of the generator, the same
     * with any standard library.
     */
    double
    uniform(std::mt19937_64 &generator)
    {
      return std::ldexp(static_cast<double>(generator() >> 11), -53);
    }
  } // namespace


  void
  SpectrumMotion::declare(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    spectrum.declare(prm);
    prm.enter_subsection("Vertical");
    vertical.declare(prm);
    prm.leave_subsection();
    prm.add_parameter("Damping ratio",
                      damping_ratio,
                      "Damping ratio of the design spectrum [-].",
                      Double(0.005, 0.3));
    prm.add_parameter("Duration",
                      duration,
                      "Length of the motion [s].",
                      Double(4., 200.));
    prm.add_parameter("Time step",
                      time_step,
                      "Time step of the samples of the motion [s].",
                      Double(0.001, 0.02));
    prm.add_parameter(
      "Rise time",
      rise_time,
      "Time in which the motion grows to its full intensity, with the square "
      "of time [s].",
      Double(0.));
    prm.add_parameter("Plateau duration",
                      plateau_duration,
                      "Time of full intensity after the rise [s].",
                      Double(0.));
    prm.add_parameter("Decay rate",
                      decay_rate,
                      "After the plateau the intensity is exp(-rate * time) "
                      "[1/s].",
                      Double(0.));
    prm.add_parameter("Seed",
                      seed,
                      "Start of the random numbers: each seed gives another "
                      "motion, the same seed always the same one.",
                      Integer(0));
    prm.add_parameter("Tolerance",
                      tolerance,
                      "Largest mean deviation from the design spectrum between "
                      "0.05 and 2 s that is accepted [-].",
                      Double(0.01, 1.));
  }


  void
  SpectrumMotion::check() const
  {
    spectrum.check("Ground motion/Spectrum");
    vertical.check("Ground motion/Spectrum/Vertical");
    if (rise_time + plateau_duration > duration)
      throw UserError(
        "\"Rise time\" and \"Plateau duration\" in section \"Ground "
        "motion/Spectrum\" are together longer than the \"Duration\"; shorten "
        "them, or lengthen the \"Duration\".");
  }


  const DesignSpectrum &
  SpectrumMotion::target(const unsigned int component) const
  {
    return component == 2 && vertical.shape != SpectrumShape::as_horizontal ?
             vertical :
             spectrum;
  }


  double
  SpectrumMotion::mean_deviation(const TimeSeries     &acceleration,
                                 const double          peak_acceleration,
                                 const DesignSpectrum &target) const
  {
    const std::vector<double> periods = logarithmic_grid(0.05, 2., 75);
    const ResponseSpectrum    obtained =
      response_spectrum(acceleration, periods, damping_ratio);

    double sum = 0;
    for (std::size_t i = 0; i < periods.size(); ++i)
      sum += std::abs(obtained.pseudo_acceleration[i] /
                        (peak_acceleration * target.amplification(periods[i])) -
                      1.);
    return sum / periods.size();
  }


  namespace
  {
    /** Intensity of the motion over time, at most 1. */
    std::vector<double>
    envelope(const SpectrumMotion &parameters)
    {
      const double plateau_end =
        parameters.rise_time + parameters.plateau_duration;

      std::vector<double> intensity(
        std::round(parameters.duration / parameters.time_step) + 1);
      for (std::size_t i = 0; i < intensity.size(); ++i)
        {
          const double t = i * parameters.time_step;
          intensity[i] =
            t < parameters.rise_time ?
              std::pow(t / parameters.rise_time, 2) :
              std::exp(-parameters.decay_rate * std::max(0., t - plateau_end));
        }
      return intensity;
    }

    /** Random phases, amplitudes that roughly fit the design spectrum. */
    TimeSeries
    random_motion(const SpectrumMotion &parameters,
                  const DesignSpectrum &target,
                  std::mt19937_64      &generator)
    {
      const std::vector<double> intensity = envelope(parameters);
      const std::size_t         size      = transform_size(intensity.size());

      // An oscillator responds to the intensity around its own frequency, in a
      // band as wide as the frequency: amplitude ~ spectral value / sqrt(f).
      std::vector<std::complex<double>> fourier(size / 2 + 1);
      for (std::size_t k = 1; k < size / 2; ++k)
        {
          const double frequency = k / (size * parameters.time_step);
          const double phase = 2. * dealii::numbers::PI * uniform(generator);
          if (1. / frequency > shortest_period &&
              1. / frequency < longest_period)
            fourier[k] = std::polar(target.amplification(1. / frequency) /
                                      std::sqrt(frequency),
                                    phase);
        }

      TimeSeries motion{parameters.time_step,
                        inverse_fourier_transform(std::move(fourier))};
      motion.values.resize(intensity.size());
      for (std::size_t i = 0; i < intensity.size(); ++i)
        motion.values[i] *= intensity[i];
      return motion;
    }

    /**
     * Scales each half wave that exceeds the peak 1 to this peak, and the
     * largest one if none does.
     */
    void
    limit_peak(std::vector<double> &a)
    {
      const double largest = peak(a);
      for (std::size_t begin = 0; begin < a.size();)
        {
          std::size_t end  = begin;
          double      top  = 0;
          const bool  sign = std::signbit(a[begin]);
          for (; end < a.size() && std::signbit(a[end]) == sign; ++end)
            top = std::max(top, std::abs(a[end]));
          if (top > 1. || top == largest)
            for (std::size_t i = begin; i < end; ++i)
              a[i] /= top;
          begin = end;
        }
    }

    /** Multiplies the Fourier amplitudes by target / obtained spectrum. */
    void
    fit_amplitudes(TimeSeries           &motion,
                   const DesignSpectrum &target,
                   const double          damping_ratio)
    {
      const std::vector<double> periods = matched_periods();
      const ResponseSpectrum    obtained =
        response_spectrum(motion, periods, damping_ratio);
      std::vector<double> ratio(periods.size());
      for (std::size_t i = 0; i < periods.size(); ++i)
        ratio[i] =
          target.amplification(periods[i]) / obtained.pseudo_acceleration[i];

      const std::size_t n       = motion.values.size();
      const std::size_t size    = transform_size(2 * n);
      auto              fourier = fourier_transform(motion.values, size);
      for (std::size_t k = 1; k < fourier.size(); ++k)
        fourier[k] *= interpolate(periods, ratio, size * motion.time_step / k);
      motion.values = inverse_fourier_transform(std::move(fourier));
      motion.values.resize(n);
    }

    void
    bring_to_rest(TimeSeries &motion)
    {
      motion.values = BaselineCorrection().apply(motion).acceleration;
    }

    void
    scale_to_unit_peak(std::vector<double> &a)
    {
      const double largest = peak(a);
      for (double &value : a)
        value /= largest;
    }

    /** The best of the iterates for one stream of random numbers. */
    TimeSeries
    matched_motion(const SpectrumMotion &parameters,
                   const DesignSpectrum &target,
                   std::mt19937_64      &generator)
    {
      TimeSeries motion = random_motion(parameters, target, generator);
      scale_to_unit_peak(motion.values);
      TimeSeries best;
      double     best_deviation = std::numeric_limits<double>::max();
      for (unsigned int i = 0; i < n_iterations; ++i)
        {
          fit_amplitudes(motion, target, parameters.damping_ratio);
          bring_to_rest(motion);
          limit_peak(motion.values);
          bring_to_rest(motion);

          TimeSeries candidate = motion;
          scale_to_unit_peak(candidate.values);
          const double deviation =
            parameters.mean_deviation(candidate, 1., target);
          if (deviation < best_deviation)
            {
              best           = candidate;
              best_deviation = deviation;
            }
        }
      return best;
    }
  } // namespace


  std::array<TimeSeries, 3>
  SpectrumMotion::generate() const
  {
    // By chance two motions may be correlated more than independent components
    // of a real earthquake; then the later one is drawn anew.
    constexpr double       largest_correlation = 0.1;
    constexpr unsigned int n_attempts          = 50;

    std::mt19937_64           generator(seed);
    std::array<TimeSeries, 3> motions;
    unsigned int              n_motions = 0;
    for (unsigned int i = 0; i < n_attempts && n_motions < 3; ++i)
      {
        motions[n_motions] =
          matched_motion(*this, target(n_motions), generator);

        const auto is_correlated = [&](const TimeSeries &other) {
          return std::abs(correlation(motions[n_motions].values,
                                      other.values)) > largest_correlation;
        };
        if (std::none_of(motions.begin(),
                         motions.begin() + n_motions,
                         is_correlated))
          ++n_motions;
      }
    if (n_motions < 3)
      throw UserError(
        "Section \"Ground motion/Spectrum\": no three motions with a "
        "correlation below 0.1 were found; lengthen the \"Duration\" or choose "
        "another \"Seed\".");

    for (unsigned int c = 0; c < 3; ++c)
      {
        const double deviation = mean_deviation(motions[c], 1., target(c));
        if (deviation > tolerance)
          throw UserError(
            "Section \"Ground motion/Spectrum\": the mean deviation from the "
            "design spectrum is " +
            std::to_string(deviation) +
            ", more than the \"Tolerance\"; choose another \"Seed\", a longer "
            "\"Duration\" or a larger \"Tolerance\".");
      }
    return motions;
  }


  double
  correlation(const std::vector<double> &a, const std::vector<double> &b)
  {
    const std::size_t n    = std::min(a.size(), b.size());
    const auto        mean = [n](const std::vector<double> &x) {
      return std::accumulate(x.begin(), x.begin() + n, 0.) / n;
    };
    const double mean_a = mean(a), mean_b = mean(b);
    double       ab = 0, aa = 0, bb = 0;
    for (std::size_t i = 0; i < n; ++i)
      {
        ab += (a[i] - mean_a) * (b[i] - mean_b);
        aa += (a[i] - mean_a) * (a[i] - mean_a);
        bb += (b[i] - mean_b) * (b[i] - mean_b);
      }
    return ab / std::sqrt(aa * bb);
  }
} // namespace Voussoir
