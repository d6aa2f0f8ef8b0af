#ifndef voussoir_signals_signal_h
#define voussoir_signals_signal_h

#include <voussoir/base/option.h>
#include <voussoir/signals/time_series.h>

namespace Voussoir
{
  /**
   * One component of a ground motion as a function of time: displacement [m],
   * velocity [m/s] and acceleration [m/s2], each the exact derivative of the
   * one before. Any time is admitted; the ground is at rest at the start.
   */
  class Signal
  {
  public:
    virtual ~Signal() = default;

    virtual double
    displacement(const double time) const = 0;

    virtual double
    velocity(const double time) const = 0;

    virtual double
    acceleration(const double time) const = 0;

    /** Time from which on the acceleration is zero [s]; may be infinite. */
    virtual double
    end() const = 0;
  };

  /** Which of the three quantities of a signal has a shape given by formula. */
  enum class Quantity
  {
    displacement,
    velocity,
    acceleration
  };

  inline OptionNames<Quantity>
  option_names(const Quantity)
  {
    return {{Quantity::displacement, "displacement"},
            {Quantity::velocity, "velocity"},
            {Quantity::acceleration, "acceleration"}};
  }

  /**
   * A motion whose three quantities are successive derivatives of one smooth
   * function of time, times a factor.
   */
  class SmoothSignal : public Signal
  {
  public:
    double
    displacement(const double time) const override
    {
      return factor * derivative(displacement_order, time);
    }

    double
    velocity(const double time) const override
    {
      return factor * derivative(displacement_order + 1, time);
    }

    double
    acceleration(const double time) const override
    {
      return factor * derivative(displacement_order + 2, time);
    }

  protected:
    /** @param displacement_order which derivative is the displacement */
    explicit SmoothSignal(const int displacement_order)
      : displacement_order(displacement_order)
    {}

    /** The derivative of that order of the function; of order -1 its integral.
     */
    virtual double
    derivative(const int order, const double time) const = 0;

    double factor = 0.;

  private:
    int displacement_order;
  };

  /**
   * The Ricker wavelet (1 - 2 a) exp(-a), a = (pi f (t - t_p))^2, of central
   * frequency f [Hz] and middle t_p [s], in the displacement, velocity or
   * acceleration. With t_p >= 1.5 / f the motion before t = 0 is below 1e-6 of
   * its peak. All three quantities return to zero.
   */
  class Ricker : public SmoothSignal
  {
  public:
    Ricker(const Quantity quantity,
           const double   frequency,
           const double   middle,
           const double   peak_acceleration);

    double
    end() const override;

  private:
    /** Of exp(-(pi f (t - t_p))^2). */
    double
    derivative(const int order, const double time) const override;

    double middle;
    /** c = (pi f)^2. */
    double c;
  };

  /**
   * A sine of given frequency [Hz] and acceleration amplitude [m/s2] that
   * starts at t = 0 and lasts @p cycles, or for ever with @p cycles = 0.
   *
   * With @p ramp_cycles = 0 the acceleration is A sin(w t) from rest, so that
   * the velocity is A/w (1 - cos(w t)) and the ground moves away at the mean
   * velocity A/w. With @p ramp_cycles >= 1 the displacement -A/w^2 sin(w t) is
   * faded in and, before the end, out over this number of cycles; the ground
   * returns to where it started. During fading the acceleration exceeds A by up
   * to 15 % for one cycle, 2 % for two, 0.5 % for three.
   */
  class Sine : public Signal
  {
  public:
    Sine(const double       frequency,
         const double       amplitude,
         const unsigned int cycles,
         const unsigned int ramp_cycles);

    double
    displacement(const double time) const override;

    double
    velocity(const double time) const override;

    double
    acceleration(const double time) const override;

    double
    end() const override;

  private:
    /** The derivative of that order of the fading factor of the displacement.
     */
    double
    fade(const unsigned int order, const double time) const;

    double omega;
    double amplitude;
    double duration;
    double ramp;
  };

  /**
   * A single push of given duration T [s] that starts at t = 0: the bump
   * 256 s^4 (1-s)^4, s = t/T, with continuous third derivative, in the
   * displacement (the ground returns) or in the velocity (it stays displaced by
   * 128/315 of T times the peak velocity).
   */
  class Pulse : public SmoothSignal
  {
  public:
    Pulse(const Quantity quantity,
          const double   duration,
          const double   peak_acceleration);

    double
    end() const override;

  private:
    /** Of the bump. */
    double
    derivative(const int order, const double time) const override;

    double duration;
  };

  /**
   * A motion given by samples: the acceleration is linear between them,
   * velocity and displacement are its exact integrals. At rest before t = 0;
   * after the last sample the acceleration is zero, the velocity constant (zero
   * after a baseline correction).
   */
  class Tabulated : public Signal
  {
  public:
    explicit Tabulated(const TimeSeries &acceleration);

    double
    displacement(const double time) const override;

    double
    velocity(const double time) const override;

    double
    acceleration(const double time) const override;

    double
    end() const override;

  private:
    Motion motion;
  };
} // namespace Voussoir

#endif
