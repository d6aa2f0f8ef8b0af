#include <voussoir/signals/signal.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Voussoir
{
  Ricker::Ricker(const Quantity quantity,
                 const double   frequency,
                 const double   middle,
                 const double   peak_acceleration)
    : SmoothSignal(quantity == Quantity::displacement ? 2 :
                   quantity == Quantity::velocity     ? 1 :
                                                        0)
    , middle(middle)
    , c(std::pow(dealii::numbers::PI * frequency, 2))
  {
    // The acceleration is the derivative of order 2, 3 or 4 of the Gaussian.
    // The third one is largest where the fourth one vanishes, that is at
    // 4 u^2 - 12 u + 3 = 0 with u = c tau^2. The sign makes the shape positive.
    const double u = (3. - std::sqrt(6.)) / 2.;
    const double largest =
      quantity == Quantity::acceleration ?
        2. * c :
      quantity == Quantity::velocity ?
        std::abs(derivative(3, middle + std::sqrt(u / c))) :
        12. * c * c;
    factor = -peak_acceleration / largest;
  }


  double
  Ricker::derivative(const int order, const double time) const
  {
    const double t = time - middle;
    const double u = c * t * t;
    const double g = std::exp(-u);
    switch (order)
      {
        case 0:
          return g;
        case 1:
          return -2. * c * t * g;
        case 2:
          return 2. * c * (2. * u - 1.) * g;
        case 3:
          return 4. * c * c * t * (3. - 2. * u) * g;
        default:
          return 4. * c * c * (4. * u * u - 12. * u + 3.) * g;
      }
  }


  double
  Ricker::end() const
  {
    return 2. * middle;
  }


  Sine::Sine(const double       frequency,
             const double       amplitude,
             const unsigned int cycles,
             const unsigned int ramp_cycles)
    : omega(2. * dealii::numbers::PI * frequency)
    , amplitude(amplitude)
    , duration(cycles > 0 ? cycles / frequency :
                            std::numeric_limits<double>::infinity())
    , ramp(ramp_cycles / frequency)
  {
    AssertThrow(2. * ramp <= duration,
                dealii::ExcMessage("The ramps are longer than the sine."));
  }


  double
  Sine::fade(const unsigned int order, const double time) const
  {
    // The polynomial of seventh degree from 0 to 1 with three vanishing
    // derivatives at either end; the descent is its mirror image.
    const bool   descent = duration - time < time;
    const double sign    = descent && order == 1 ? -1. : 1.;
    const double s =
      std::clamp((descent ? duration - time : time) / ramp, 0., 1.);
    switch (order)
      {
        case 0:
          return std::pow(s, 4) * (35. + s * (-84. + s * (70. - 20. * s)));
        case 1:
          return sign * 140. * std::pow(s * (1. - s), 3) / ramp;
        default:
          return 420. * std::pow(s * (1. - s), 2) * (1. - 2. * s) /
                 (ramp * ramp);
      }
  }


  double
  Sine::displacement(const double time) const
  {
    const double t = std::clamp(time, 0., duration);
    if (ramp > 0)
      return -amplitude / (omega * omega) * fade(0, t) * std::sin(omega * t);

    const double after = time > duration ? time - duration : 0.;
    return amplitude / omega * (t - std::sin(omega * t) / omega) +
           velocity(t) * after;
  }


  double
  Sine::velocity(const double time) const
  {
    const double t = std::clamp(time, 0., duration);
    if (ramp > 0)
      return -amplitude / (omega * omega) *
             (fade(1, t) * std::sin(omega * t) +
              fade(0, t) * omega * std::cos(omega * t));

    return amplitude / omega * (1. - std::cos(omega * t));
  }


  double
  Sine::acceleration(const double time) const
  {
    if (time < 0. || time > duration)
      return 0.;
    if (ramp > 0)
      return amplitude *
             (fade(0, time) * std::sin(omega * time) -
              2. * fade(1, time) * std::cos(omega * time) / omega -
              fade(2, time) * std::sin(omega * time) / (omega * omega));

    return amplitude * std::sin(omega * time);
  }


  double
  Sine::end() const
  {
    return duration;
  }


  Pulse::Pulse(const Quantity quantity,
               const double   duration,
               const double   peak_acceleration)
    : SmoothSignal(quantity == Quantity::displacement ? 0 : -1)
    , duration(duration)
  {
    AssertThrow(quantity != Quantity::acceleration,
                dealii::ExcMessage(
                  "A pulse of the acceleration would never come to rest."));

    // The second derivative of the bump is largest in its middle, the first one
    // where s (1-s) = 3/14.
    const double largest =
      quantity == Quantity::displacement ?
        32. / (duration * duration) :
        1024. * std::pow(3. / 14., 3) * std::sqrt(1. / 7.) / duration;
    factor = peak_acceleration / largest;
  }


  double
  Pulse::derivative(const int order, const double time) const
  {
    const double s     = std::clamp(time / duration, 0., 1.);
    const double q     = s * (1. - s);
    const double slope = 1. - 2. * s;
    switch (order)
      {
        case -1:
          return 256. * duration * std::pow(s, 5) *
                 (1. / 5. +
                  s * (-2. / 3. + s * (6. / 7. + s * (-1. / 2. + s / 9.))));
        case 0:
          return 256. * std::pow(q, 4);
        case 1:
          return 1024. * std::pow(q, 3) * slope / duration;
        default:
          return 1024. * q * q * (3. * slope * slope - 2. * q) /
                 (duration * duration);
      }
  }


  double
  Pulse::end() const
  {
    return duration;
  }


  Tabulated::Tabulated(const TimeSeries &acceleration)
    : motion(integrate(acceleration))
  {
    AssertThrow(motion.time_step > 0 && motion.acceleration.size() > 1,
                dealii::ExcMessage("A motion needs two samples at least."));
  }


  namespace
  {
    /** A time in a table: the sample before it, and the time since [s]. */
    struct Position
    {
      std::size_t index;
      double      time;
    };

    Position
    locate(const Motion &motion, const double time)
    {
      const std::size_t last_interval = motion.acceleration.size() - 2;
      const std::size_t index =
        std::min(static_cast<std::size_t>(time / motion.time_step),
                 last_interval);
      return {index, time - index * motion.time_step};
    }

    double
    slope(const Motion &motion, const std::size_t index)
    {
      return (motion.acceleration[index + 1] - motion.acceleration[index]) /
             motion.time_step;
    }
  } // namespace


  double
  Tabulated::displacement(const double time) const
  {
    if (time <= 0)
      return 0;
    if (time >= end())
      return motion.displacement.back() +
             motion.velocity.back() * (time - end());

    const auto [i, t] = locate(motion, time);
    return motion.displacement[i] +
           t * (motion.velocity[i] +
                t * (motion.acceleration[i] / 2. + t * slope(motion, i) / 6.));
  }


  double
  Tabulated::velocity(const double time) const
  {
    if (time <= 0)
      return 0;
    if (time >= end())
      return motion.velocity.back();

    const auto [i, t] = locate(motion, time);
    return motion.velocity[i] +
           t * (motion.acceleration[i] + t * slope(motion, i) / 2.);
  }


  double
  Tabulated::acceleration(const double time) const
  {
    if (time < 0 || time > end())
      return 0;

    const auto [i, t] = locate(motion, time);
    return motion.acceleration[i] + t * slope(motion, i);
  }


  double
  Tabulated::end() const
  {
    return motion.time_step * (motion.acceleration.size() - 1.);
  }
} // namespace Voussoir
