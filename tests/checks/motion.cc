#include <voussoir/base/error.h>
#include <voussoir/loads/ground_motion.h>
#include <voussoir/signals/deconvolution.h>
#include <voussoir/signals/response_spectrum.h>

#include <fstream>
#include <iomanip>
#include <sstream>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    TimeSeries
    read_text(const std::string &text, const RecordFormat &format = {})
    {
      std::ofstream("record.txt") << text;
      return read_record("record.txt", format);
    }


    bool
    is_refused(const std::string &text)
    {
      try
        {
          read_text(text);
        }
      catch (const UserError &)
        {
          return true;
        }
      return false;
    }


    /** The headers of AT2 files, tables, and incomplete records. */
    void
    check_records(const TimeSeries &elcentro, Verdicts &verdicts)
    {
      const std::string numbers = ".1 .2 .3\n -.4E+00 0.5D0\n+.6\n";
      for (const auto &[name, header] : std::map<std::string, std::string>{
             {"of PEER", "A\nB\nUNITS OF G\nNPTS= 6, DT= .02000 SEC\n"},
             {"with filters",
              "A\nB\nC\nNPTS=  6, DT=  .0200 SEC,   0 POLE @    30.00000 HZ\n"},
             {"with numbers first", "A\n1940 text\n6   0.0200  NPTS, DT\n"},
             {"in small letters",
              "dt = 2e-2 s\r\nnpts: 6\r\nfurther words\r\n"}})
        {
          const TimeSeries series = read_text(header + numbers);
          verdicts.is_true("AT2 header " + name,
                           series.time_step == 0.02 &&
                             series.values.size() == 6 &&
                             std::abs(series.values[4] - 0.5 * 9.81) < 1e-15 &&
                             series.values[3] < 0.);
        }
      const TimeSeries table = read_text("# comment\ntime;x;y\n0;1;10\n"
                                         "0.01;2;20\n0.02;3;30\n",
                                         {AccelerationUnit::cm_per_s2, 0, 2});
      verdicts.is_true("second column of a table in gal",
                       std::abs(table.values[2] - 0.3) < 1e-15 &&
                         std::abs(table.time_step - 0.01) < 1e-15);

      std::ostringstream rounded;
      rounded << std::fixed << std::setprecision(4);
      for (unsigned int i = 0; i <= 1280; ++i)
        rounded << i / 128. << ' ' << i % 7 << '\n';
      verdicts.near("step of times of 1/128 s with four decimals",
                    read_text(rounded.str()).time_step,
                    1. / 128.,
                    1e-6,
                    "s");

      const std::string header = "NPTS= 3, DT= .02 SEC\n";
      for (const auto &[what, text] : std::map<std::string, std::string>{
             {"no number", "one\ntwo\n"},
             {"infinity", header + "1 2\n-inf\n"},
             {"too many values", header + "1 2 3 4\n"},
             {"no time step", "NPTS= 3\n1 2 3\n"},
             {"a velocity",
              "VELOCITY TIME SERIES IN UNITS OF CM/S\n" + header + "1 2 3\n"},
             {"uneven times", "0 1\n.01 1\n.023 1\n"},
             {"falling times", "0 1\n.01 1\n.005 1\n"},
             {"a missing column", "0 1\n.01 1\n.02\n"}})
        verdicts.is_true("refused: " + what, is_refused(text));

      verdicts.near("El Centro, peak acceleration",
                    peak(elcentro.values) / standard_gravity,
                    0.31882,
                    1e-5,
                    "g");
      verdicts.near("El Centro, peak velocity",
                    peak(integrate(elcentro).velocity),
                    0.3615,
                    1e-3,
                    "m/s");
    }


    /** After a correction the ground ends at rest, and shakes as before. */
    void
    check_baseline(const TimeSeries &elcentro, Verdicts &verdicts)
    {
      for (const BaselineMethod method :
           {BaselineMethod::polynomial, BaselineMethod::high_pass})
        {
          BaselineCorrection baseline;
          baseline.method     = method;
          const Motion motion = baseline.apply(elcentro);
          verdicts.near(option_name(method) +
                          ": peak acceleration over the record's",
                        peak(motion.acceleration) / peak(elcentro.values),
                        1.,
                        0.01);
          verdicts.below("  velocity and displacement at the end",
                         std::abs(motion.velocity.back()) +
                           std::abs(motion.displacement.back()),
                         1e-12);
        }
    }


    /** Velocity and acceleration are the derivatives; the peak is the given
     * one. */
    void
    check_signal(const std::string &name,
                 const Signal      &signal,
                 const double       end,
                 const double       peak_acceleration,
                 const double       tolerance,
                 Verdicts          &verdicts)
    {
      const double h        = 1e-6;
      double       velocity = 0., acceleration = 0.;
      double       velocity_error = 0., acceleration_error = 0.;
      for (double t = -0.1 * end + 1e-5; t < 1.1 * end; t += end / 4001.)
        {
          const double v = signal.velocity(t), a = signal.acceleration(t);
          keep_largest(velocity, std::abs(v));
          keep_largest(velocity_error,
                       std::abs((signal.displacement(t + h) -
                                 signal.displacement(t - h)) /
                                  (2. * h) -
                                v));
          keep_largest(acceleration_error,
                       std::abs(
                         (signal.velocity(t + h) - signal.velocity(t - h)) /
                           (2. * h) -
                         a));
        }
      // at steps that include the samples of a table, where its peak is
      for (unsigned int i = 0; i <= 15500; ++i)
        keep_largest(acceleration,
                     std::abs(signal.acceleration(end * i / 15500.)));
      verdicts.below(name + ": d' = v", velocity_error / velocity, 1e-5);
      verdicts.below("  v' = a", acceleration_error / acceleration, 1e-3);
      verdicts.near("  peak acceleration",
                    acceleration,
                    peak_acceleration,
                    tolerance,
                    "m/s2");
    }


    void
    check_signals(const TimeSeries &elcentro, Verdicts &verdicts)
    {
      for (const auto &[name, quantity] : std::map<std::string, Quantity>{
             {"displacement", Quantity::displacement},
             {"velocity", Quantity::velocity},
             {"acceleration", Quantity::acceleration}})
        check_signal("Ricker in " + name,
                     Ricker(quantity, 4., 0.375, 2.),
                     0.75,
                     2.,
                     1e-5,
                     verdicts);
      check_signal("pulse",
                   Pulse(Quantity::displacement, 0.5, 2.),
                   0.5,
                   2.,
                   1e-5,
                   verdicts);
      // during fading a sine exceeds its amplitude by two percent
      check_signal("sine", Sine(2., 3., 6, 2), 3., 3., 0.02, verdicts);
      check_signal("table",
                   Tabulated(elcentro),
                   31.,
                   peak(elcentro.values),
                   1e-5,
                   verdicts);

      // the acceleration t has the integrals t^2/2 and t^3/6
      TimeSeries ramp{0.1, {}};
      for (unsigned int i = 0; i <= 10; ++i)
        ramp.values.push_back(0.1 * i);
      const Tabulated cubic(ramp);
      verdicts.below("ramp: integrals between the samples",
                     std::abs(cubic.displacement(0.77) -
                              std::pow(0.77, 3) / 6.) +
                       std::abs(cubic.velocity(0.77) - 0.77 * 0.77 / 2.),
                     1e-15);
      verdicts.below("ramp: coasts after the end",
                     cubic.displacement(2.) - (1. / 6. + 0.5),
                     1e-15);
    }


    void
    check_response_spectrum(Verdicts &verdicts)
    {
      // constant acceleration, applied suddenly: 1 + exp(-pi xi / sqrt(1 -
      // xi^2))
      for (const double xi : {0., 0.05, 0.2})
        verdicts.near(
          "suddenly constant acceleration, amplification",
          response_spectrum({0.01, std::vector<double>(1000, 2.)}, {0.3}, xi)
              .pseudo_acceleration[0] /
            2.,
          1. + std::exp(-numbers::PI * xi / std::sqrt(1. - xi * xi)),
          2e-3);
      // half a sine of the length of the period, undamped: Chopra, section 4.8
      TimeSeries half{0.002, {}};
      for (unsigned int i = 0; i <= 500; ++i)
        half.values.push_back(std::sin(numbers::PI * i * 0.002));
      const auto spectrum = response_spectrum(half, {2., 4.}, 0.);
      verdicts.near("half sine of half the period",
                    spectrum.pseudo_acceleration[0],
                    numbers::PI / 2.,
                    2e-3);
      verdicts.near("half sine of a quarter of the period",
                    spectrum.pseudo_acceleration[1],
                    4. / 3. * std::cos(numbers::PI / 4.),
                    2e-3);
      TimeSeries sine{0.005, {}};
      for (unsigned int i = 0; i <= 20000; ++i)
        sine.values.push_back(std::sin(2. * numbers::PI * i * 0.005));
      verdicts.near("resonance",
                    response_spectrum(sine, {1.}, 0.05).pseudo_acceleration[0],
                    1. / (2. * 0.05),
                    2e-3);
    }


    /**
     * A layer on rock: a wave arrives after 20 steps, doubled, and again every
     * 26 steps, with reversed sign and 0.4 times as large. Deconvolution
     * computes the input from the response.
     */
    void
    check_deconvolution(const TimeSeries &elcentro, Verdicts &verdicts)
    {
      const auto layer = [](const std::vector<double> &x) {
        std::vector<double> y(x.size());
        for (std::size_t i = 0; i < x.size(); ++i)
          y[i] =
            (i >= 20 ? 2. * x[i - 20] : 0.) - (i >= 26 ? 0.4 * y[i - 26] : 0.);
        return y;
      };
      const double dt = 0.005;
      TimeSeries   excitation{dt, std::vector<double>(2000)};
      const Ricker wavelet(Quantity::acceleration, 10., 0.15, 1.);
      for (std::size_t i = 0; i < 2000; ++i)
        excitation.values[i] = wavelet.acceleration(i * dt);
      const TimeSeries response{dt, layer(excitation.values)};

      // the record without frequencies above the given one
      const Tabulated table(
        {elcentro.time_step,
         BaselineCorrection().apply(elcentro).acceleration});
      TimeSeries raw{dt, std::vector<double>(8000)};
      for (std::size_t i = 0; i < raw.values.size(); ++i)
        raw.values[i] = table.acceleration(i * dt - 2.);
      const auto input = deconvolve(excitation, excitation, raw, 16.);
      const auto found =
        deconvolve(response, excitation, {dt, layer(input)}, 20.);
      double error = 0.;
      for (std::size_t i = 0; i < found.size(); ++i)
        keep_largest(error, std::abs(found[i] - input[i]));
      verdicts.below("deconvolution: error over the peak",
                     error / peak(input),
                     2e-5);
    }


    /** Largest pseudo-acceleration of an oscillator of 5 % damping, by central
     *  differences in steps of 1/200 of its period or less. */
    double
    pseudo_acceleration(const TimeSeries &base, const double period)
    {
      const double       omega = 2. * numbers::PI / period, xi = 0.05;
      const unsigned int fine =
        std::ceil(std::max(1., 200. * base.time_step / period));
      const double dt = base.time_step / fine;
      double       u = 0., before = 0., largest = 0.;
      for (std::size_t i = 0; i + 1 < base.values.size(); ++i)
        for (unsigned int k = 0; k < fine; ++k)
          {
            const double share = double(k) / fine;
            const double a =
              (1. - share) * base.values[i] + share * base.values[i + 1];
            const double after = (2. * u - (1. - xi * omega * dt) * before -
                                  dt * dt * (omega * omega * u + a)) /
                                 (1. + xi * omega * dt);
            before = u;
            u      = after;
            keep_largest(largest, std::abs(u));
          }
      return omega * omega * largest;
    }


    /** Mean deviation from the spectrum of NB 35047: from 1 up to 2.5 at 0.1 s,
     *  constant to the characteristic period, then falling with the power 0.6.
     */
    double
    deviation_from_code(const TimeSeries &motion,
                        const double      characteristic_period = 0.2)
    {
      double             sum = 0.;
      const unsigned int n   = 40;
      for (unsigned int i = 0; i < n; ++i)
        {
          const double T = 0.05 * std::pow(40., double(i) / (n - 1));
          const double wanted =
            T < 0.1 ?
              1. + 15. * T :
              2.5 * std::pow(std::min(1., characteristic_period / T), 0.6);
          sum += std::abs(pseudo_acceleration(motion, T) / wanted - 1.) / n;
        }
      return sum;
    }


    void
    check_spectrum_motion(Verdicts &verdicts)
    {
      SpectrumMotion generator;
      generator.duration         = 12.;
      generator.plateau_duration = 5.;
      const auto motion          = generator.generate();
      for (unsigned int c = 0; c < 3; ++c)
        {
          verdicts.below("generated motion: mean deviation from the spectrum",
                         deviation_from_code(motion[c]),
                         0.05);
          verdicts.near("  peak", peak(motion[c].values), 1., 1e-12);
          verdicts.below("  correlation with the next component",
                         correlation(motion[c].values,
                                     motion[(c + 1) % 3].values),
                         0.1);
          const Motion whole = integrate(motion[c]);
          verdicts.below("  velocity and displacement at the end",
                         std::abs(whole.velocity.back()) +
                           std::abs(whole.displacement.back()),
                         1e-12);
        }
    }


    /** A vertical component that follows a spectrum of its own. */
    void
    check_vertical_spectrum(Verdicts &verdicts)
    {
      SpectrumMotion generator;
      generator.duration                       = 12.;
      generator.plateau_duration               = 5.;
      generator.tolerance                      = 0.1;
      const auto as_horizontal                 = generator.generate();
      generator.vertical.shape                 = SpectrumShape::hydropower_code;
      generator.vertical.characteristic_period = 0.12;
      const auto motion                        = generator.generate();
      verdicts.is_true("vertical spectrum: the others stay as they are",
                       motion[0].values == as_horizontal[0].values &&
                         motion[1].values == as_horizontal[1].values);
      verdicts.below("  mean deviation from its own",
                     deviation_from_code(motion[2], 0.12),
                     0.1);
      verdicts.above("  from the horizontal one",
                     deviation_from_code(motion[2]),
                     0.15);
    }


    /** Treatment of a record by section "Ground motion". */
    void
    check_section(const std::string &record, Verdicts &verdicts)
    {
      GroundMotion motion;
      motion.type              = GroundMotionType::record;
      motion.peak_entries      = {{"as recorded", "0.2", "0"}};
      motion.overload_factor   = 1.5;
      motion.record.files      = {{record, record, ""}};
      motion.record.start_time = 1.;
      motion.record.duration   = 20.;
      motion.check();
      const auto signals = motion.build(".");
      double     largest = 0.;
      for (unsigned int i = 0; i <= 20000; ++i)
        keep_largest(largest, std::abs(signals[1]->acceleration(0.001 * i)));
      verdicts.near("record scaled to 0.2 g, 1.5 times",
                    largest / standard_gravity,
                    0.3,
                    1e-9,
                    "g");
      verdicts.near("its length", signals[0]->end(), 20., 1e-9, "s");
      verdicts.is_true("no vertical motion without a file", !signals[2]);

      motion.reversed     = "y";
      const auto reversed = motion.build(".");
      double     kept = 0., turned = 0.;
      for (double t = 0.; t < 20.; t += 0.013)
        {
          keep_largest(kept,
                       std::abs(reversed[0]->acceleration(t) -
                                signals[0]->acceleration(t)));
          keep_largest(turned,
                       std::abs(reversed[1]->acceleration(t) +
                                signals[1]->acceleration(t)));
        }
      verdicts.is_true("reversed: y turned, x as it was",
                       kept == 0. && turned == 0.);
    }


    /** Sources of ground motion, against closed forms. */
    class GroundMotionCheck : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        const std::string record =
          file.resolve("../../prm/records/elcentro_1940_ns.txt");
        const TimeSeries elcentro = read_record(record, {});
        check_records(elcentro, verdicts);
        check_baseline(elcentro, verdicts);
        check_signals(elcentro, verdicts);
        check_response_spectrum(verdicts);
        check_deconvolution(elcentro, verdicts);
        check_spectrum_motion(verdicts);
        check_vertical_spectrum(verdicts);
        check_section(record, verdicts);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<GroundMotionCheck>
      registered("ground motion", "Records, signals, spectra, deconvolution.");
  } // namespace
} // namespace Voussoir
