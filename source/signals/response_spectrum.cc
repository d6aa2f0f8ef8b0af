#include <voussoir/signals/response_spectrum.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace Voussoir
{
  namespace
  {
    /** One oscillator under an acceleration that is linear in each step. */
    class Oscillator
    {
    public:
      Oscillator(const double omega,
                 const double damping_ratio,
                 const double time_step)
      {
        for (unsigned int i = 0; i < 4; ++i)
          {
            std::array<double, 4> unit{};
            unit[i]           = 1.;
            const auto [u, v] = advanced(unit, omega, damping_ratio, time_step);
            to_displacement[i] = u;
            to_velocity[i]     = v;
          }
      }

      /** One step in which the acceleration is a + s t. */
      void
      advance(const double a, const double s)
      {
        const std::array<double, 4> state{{a, s, u, v}};
        u = std::inner_product(state.begin(),
                               state.end(),
                               to_displacement.begin(),
                               0.);
        v = std::inner_product(state.begin(),
                               state.end(),
                               to_velocity.begin(),
                               0.);
      }

      double
      displacement() const
      {
        return u;
      }

    private:
      /**
       * u'' + 2 xi w u' + w^2 u = -(a + s t) over one step: the particular
       * solution p(t) = -(a + s t)/w^2 + 2 xi s/w^3 plus a free oscillation.
       *
       * @param state a, s, displacement and velocity
       * @return displacement and velocity at the end
       */
      static std::pair<double, double>
      advanced(const std::array<double, 4> &state,
               const double                 omega,
               const double                 xi,
               const double                 h)
      {
        const auto [a, s, u, v]   = state;
        const double damped_omega = omega * std::sqrt(1. - xi * xi),
                     decay        = std::exp(-xi * omega * h),
                     cosine       = decay * std::cos(damped_omega * h),
                     sine         = decay * std::sin(damped_omega * h);
        const double p_0 =
          -a / (omega * omega) + 2. * xi * s / std::pow(omega, 3);
        const double p_slope = -s / (omega * omega);

        const double u_free = u - p_0;
        const double c = (v - p_slope + xi * omega * u_free) / damped_omega;
        return {p_0 + p_slope * h + cosine * u_free + sine * c,
                p_slope + cosine * (damped_omega * c - xi * omega * u_free) -
                  sine * (damped_omega * u_free + xi * omega * c)};
      }

      std::array<double, 4> to_displacement, to_velocity; // over a step

      double u = 0, v = 0;
    };
  } // namespace


  PeakResponse
  peak_response(const TimeSeries &acceleration,
                const double      period,
                const double      damping_ratio)
  {
    const std::vector<double> &a = acceleration.values;

    const unsigned int substeps =
      std::max(1., std::ceil(40. * acceleration.time_step / period));
    const double h = acceleration.time_step / substeps;

    Oscillator oscillator(2. * dealii::numbers::PI / period, damping_ratio, h);
    PeakResponse peak;
    std::size_t  n_steps = 0;
    const auto   step    = [&](const double a_0, const double slope) {
      oscillator.advance(a_0, slope);
      ++n_steps;
      if (std::abs(oscillator.displacement()) > std::abs(peak.displacement))
        peak = {oscillator.displacement(), n_steps * h};
    };

    for (std::size_t i = 1; i < a.size(); ++i)
      {
        const double slope = (a[i] - a[i - 1]) / acceleration.time_step;
        for (unsigned int j = 0; j < substeps; ++j)
          step(a[i - 1] + j * h * slope, slope);
      }
    for (double t = 0; t < period; t += h)
      step(0, 0);
    return peak;
  }


  ResponseSpectrum
  response_spectrum(const TimeSeries          &acceleration,
                    const std::vector<double> &periods,
                    const double               damping_ratio)
  {
    ResponseSpectrum spectrum;
    spectrum.periods = periods;
    for (const double period : periods)
      {
        if (period == 0)
          {
            spectrum.displacement.push_back(0);
            spectrum.pseudo_acceleration.push_back(peak(acceleration.values));
            continue;
          }
        const double omega        = 2. * dealii::numbers::PI / period;
        const double displacement = std::abs(
          peak_response(acceleration, period, damping_ratio).displacement);
        spectrum.displacement.push_back(displacement);
        spectrum.pseudo_acceleration.push_back(omega * omega * displacement);
      }
    return spectrum;
  }


  std::vector<double>
  logarithmic_grid(const double       first,
                   const double       last,
                   const unsigned int number)
  {
    std::vector<double> grid(number);
    for (unsigned int i = 0; i < number; ++i)
      grid[i] = first * std::pow(last / first, i / (number - 1.));
    return grid;
  }
} // namespace Voussoir
