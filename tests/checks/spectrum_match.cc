#include <voussoir/signals/record.h>
#include <voussoir/signals/response_spectrum.h>
#include <voussoir/signals/spectrum_match.h>
#include <voussoir/signals/spectrum_motion.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Pseudo-acceleration of an oscillator by Newmark's average acceleration,
     *  not by the method of the program. */
    double
    newmark(const TimeSeries &motion, const double period, const double damping)
    {
      const double omega = 2. * numbers::PI / period;
      const auto   parts =
        static_cast<unsigned int>(std::ceil(200. * motion.time_step / period));
      const double h = motion.time_step / parts;
      const double effective =
        omega * omega + 4. * damping * omega / h + 4. / (h * h);
      double     u = 0., v = 0., a = -motion.values[0], largest = 0.;
      const auto step = [&](const double ground) {
        const double right = -ground + 4. / (h * h) * u + 4. / h * v + a +
                             2. * damping * omega * (2. / h * u + v);
        const double next = right / effective, rate = 2. / h * (next - u) - v;
        u       = next;
        v       = rate;
        a       = -ground - 2. * damping * omega * v - omega * omega * u;
        largest = std::max(largest, std::abs(u));
      };
      for (std::size_t i = 1; i < motion.values.size(); ++i)
        for (unsigned int j = 1; j <= parts; ++j)
          step(motion.values[i - 1] +
               (motion.values[i] - motion.values[i - 1]) * j / double(parts));
      for (double t = 0.; t < period; t += h)
        step(0.);
      return omega * omega * largest;
    }


    /** Records that are fitted to the spectrum of NB 35047, 0.3 g, and by one
     *  factor. */
    class SpectrumMatchCheck : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        verdict = &verdicts;
        // A sin(w t) over five cycles: pi/(2 g) A^2 T/2
        TimeSeries sine{1e-3, {}};
        for (unsigned int i = 0; i <= 2500; ++i)
          sine.values.push_back(2. * std::sin(4. * numbers::PI * i * 1e-3));
        verdicts.near("Arias intensity of a sine [m/s]",
                      arias_intensity(sine),
                      numbers::PI / (2. * standard_gravity) * 4. * 2.5 / 2.,
                      1e-4);

        const TimeSeries elcentro =
          read_record(file.resolve("../../prm/records/elcentro_1940_ns.txt"),
                      {});
        match("El Centro 1940", elcentro);

        SpectrumMotion soft;
        soft.spectrum.characteristic_period = 0.9;
        soft.seed                           = 3;
        match("a motion of soft ground", soft.generate()[0]);

        // from 8 to 0.4 Hz in 30 s, as a sweep of a shaking table
        TimeSeries sweep{0.01, {}};
        for (double t = 0., phase = 0.; t < 30.; t += sweep.time_step)
          {
            phase +=
              2. * numbers::PI * sweep.time_step * 8. * std::pow(0.05, t / 30.);
            sweep.values.push_back(std::sin(numbers::PI * t / 30.) *
                                   std::sin(phase));
          }
        match("a sweep", sweep);

        one_factor(elcentro, sweep);
      }

    private:
      void
      match(const std::string &name, const TimeSeries &record) const
      {
        const DesignSpectrum target;
        SpectrumMatch        parameters;
        parameters.method = MatchMethod::each_component;
        std::vector<SpectrumFit> fits(1);
        fits[0].periods = parameters.periods();
        for (const double period : fits[0].periods)
          fits[0].target.push_back(0.3 * standard_gravity *
                                   target.amplification(period));
        fit_to_spectrum({record}, parameters, 0.05, fits);

        const auto periods = logarithmic_grid(0.031, 4.9, 61);
        double     before = 0., sum = 0., largest = 0.;
        for (const double period : periods)
          {
            const double wanted =
              0.3 * standard_gravity * target.amplification(period);
            const auto misfit = [&](const TimeSeries &motion,
                                    const double      factor) {
              return std::abs(factor * newmark(motion, period, 0.05) / wanted -
                              1.);
            };
            before += misfit(record, fits[0].factor) / periods.size();
            const double own = misfit(fits[0].acceleration, 1.);
            sum += own / periods.size();
            keep_largest(largest, own);
          }
        verdict->above(name + ": mean misfit of the scaled record",
                       before,
                       0.2);
        verdict->below("  of the matched motion, by Newmark", sum, 0.05);
        verdict->below("  largest misfit, by Newmark", largest, 0.15);
        verdict->below("  misfit by the program, difference",
                       fits[0].mean_misfit() - sum,
                       0.01);
        const Motion motion = integrate(fits[0].acceleration);
        verdict->below("  velocity and displacement at the end",
                       std::abs(motion.velocity.back()) +
                         std::abs(motion.displacement.back()),
                       1e-9);
        double squares = 0.;
        for (const double a : motion.acceleration)
          squares += a * a * motion.time_step;
        verdict->near("  Arias intensity [m/s]",
                      fits[0].arias_after,
                      numbers::PI / (2. * standard_gravity) * squares,
                      0.01);
        verdict->is_true("  not that of the scaled record",
                         std::abs(fits[0].arias_after / fits[0].arias_before -
                                  1.) > 0.01);
      }

      // two targets, twice and eight times the records' own spectra: the factor
      // is the geometric mean, four
      void
      one_factor(const TimeSeries &first, const TimeSeries &second) const
      {
        SpectrumMatch parameters;
        parameters.method          = MatchMethod::one_factor;
        parameters.shortest_period = 0.1;
        parameters.longest_period  = 2.;
        std::vector<SpectrumFit>      fits(2);
        const std::vector<TimeSeries> records{first, second};
        for (unsigned int c = 0; c < 2; ++c)
          {
            fits[c].periods = parameters.periods();
            fits[c].target =
              response_spectrum(records[c], fits[c].periods, 0.05)
                .pseudo_acceleration;
            for (double &value : fits[c].target)
              value *= c == 0 ? 2. : 8.;
          }
        fit_to_spectrum(records, parameters, 0.05, fits);
        for (unsigned int c = 0; c < 2; ++c)
          {
            verdict->near("one factor for two components",
                          fits[c].factor,
                          4.,
                          1e-3);
            verdict->near("  peak acceleration over that of the record",
                          peak(fits[c].acceleration.values) /
                            peak(records[c].values),
                          4.,
                          1e-3);
            verdict->near("  mean misfit",
                          fits[c].mean_misfit(),
                          c == 0 ? 1. : 0.5,
                          1e-2);
          }
      }

      Verdicts *verdict = nullptr;
    };

    // Reference: published
    const Registry<Check>::Add<SpectrumMatchCheck>
      registered("spectrum match", "Records fitted to a target spectrum.");
  } // namespace
} // namespace Voussoir
