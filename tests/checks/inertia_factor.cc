#include <voussoir/base/error.h>

#include "check.h"
#include "histories.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A material with a quarter of its inertia vibrates twice as fast and has
     * the same weight: a bar of n cells that hangs from its base, whose lowest
     * circular frequency is 2 c/h sin(pi/4n).
     */
    class InertiaFactor : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Cells", n, "Along the bar.");
        prm.add_parameter("Volume", volume, "Volume of the bar [m3].");
        prm.add_parameter("Length", length, "Length of the bar [m].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const Measured whole   = measure(file, 1., communicator),
                       quarter = measure(file, 0.25, communicator);
        const double c = std::sqrt(30e9 / (1. - 2. * 0.2 * 0.2 / (1. - 0.2)) /
                                   2400.); // between rollers
        const double period =
          2. * numbers::PI /
          (2. * c * n / length * std::sin(numbers::PI / (4. * n)));
        verdicts.near("period of mode 1", whole.of_mode, period, 1e-9, "s");
        verdicts.near("period of free oscillation",
                      whole.of_oscillation,
                      period,
                      5e-4,
                      "s");
        verdicts.near("a quarter of the inertia: period of mode 1",
                      quarter.of_mode,
                      0.5 * period,
                      1e-9,
                      "s");
        verdicts.near("a quarter: period of free oscillation",
                      quarter.of_oscillation,
                      0.5 * period,
                      5e-4,
                      "s");
        verdicts.near("a quarter: time step over that of the whole",
                      quarter.time_step / whole.time_step,
                      0.5,
                      1e-6);
        verdicts.near("a quarter: mass that moves",
                      quarter.moving_mass,
                      0.25 * 2400. * volume * (1. - 0.5 / n),
                      1e-12,
                      "kg");
        for (const double factor : {1., 0.25})
          weigh(file, factor, communicator, verdicts);
        verdicts.is_true("no inertia at all is refused", is_refused(file));
      }

    private:
      struct Measured
      {
        double of_mode, of_oscillation, time_step; // [s]
        double moving_mass;                        // [kg]
      };


      static std::string
      entry(const double factor)
      {
        return "Materials/concrete/Inertia factor=" + std::to_string(factor);
      }


      Measured
      measure(const ParameterFile &file,
              const double         factor,
              const MPI_Comm       communicator) const
      {
        const auto  still = make_case(file.with({entry(factor)}));
        const auto  modes = make_simulation(*still, communicator);
        const Mode &mode  = modes->modes.list[0];

        // a run of modes alone takes no steps
        const auto parameters =
          make_case(file.with({entry(factor), "Modes/Number=0"}));
        const auto simulation = make_simulation(*parameters, communicator);
        simulation->run.state.displacement = mode.shape;
        const auto histories =
          run_and_record(*simulation, {{"tip", Point<3>(0.5, 0.5, -length)}});
        return {1. / mode.frequency,
                period_of(histories.times, histories.component(0, 2)),
                simulation->run.time_step.length,
                modes->modes.moving_mass[2]};
      }


      /** Period, from the first passage through zero to the last one. */
      static double
      period_of(const std::vector<double> &times, const std::vector<double> &u)
      {
        std::vector<double> zeros;
        for (std::size_t i = 1; i < u.size(); ++i)
          if (u[i - 1] * u[i] < 0.)
            zeros.push_back(times[i - 1] + (times[i] - times[i - 1]) *
                                             u[i - 1] / (u[i - 1] - u[i]));
        return zeros.size() < 3 ?
                 0. :
                 2. * (zeros.back() - zeros.front()) / (zeros.size() - 1.);
      }


      /** The weight and the reactions to it. */
      void
      weigh(const ParameterFile &file,
            const double         factor,
            const MPI_Comm       communicator,
            Verdicts            &verdicts) const
      {
        const auto parameters =
          make_case(file.with({entry(factor),
                               "Loads/Names=weight",
                               "Loads/weight/Class=gravity",
                               "Static state/Stages=weight"}));
        const auto  simulation = make_simulation(*parameters, communicator);
        const auto &stage = simulation->static_state.summary.at("stages").at(0);
        const double      weight = 2400. * volume * 9.81;
        const std::string name =
          std::string("inertia factor ") + (factor < 1. ? "1/4" : "1");
        verdicts.near(name + ": weight",
                      stage.at("loads").at("weight").at("resultant [N]")[2],
                      -weight,
                      1e-12,
                      "N");
        verdicts.near(name + ": reactions",
                      stage.at("sum of reactions [N]")[2],
                      weight,
                      1e-6,
                      "N");
      }


      static bool
      is_refused(const ParameterFile &file)
      {
        try
          {
            make_case(file.with({entry(0.)}));
          }
        catch (const UserError &)
          {
            return true;
          }
        return false;
      }

      unsigned int n      = 1;
      double       volume = 1., length = 1.;
    };

    // Reference: closed form
    const Registry<Check>::Add<InertiaFactor> registered("inertia factor",
                                                         "Periods and weight.");
  } // namespace
} // namespace Voussoir
