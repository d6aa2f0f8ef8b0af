#include "csv_table.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A column of rock that flows to and fro at 2 Hz, under Maxwell damping:
     * its force beside that of a bar of three Maxwell branches and a spring in
     * series with plastic flow at the uniaxial strengths of the cone, by small
     * steps of its own; at rest the branches are relaxed. They act on the
     * elastic strain alone, so that damping returns no energy.
     */
    class DampedFlow : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Strength in compression", compressive, "[Pa]");
        prm.add_parameter("Strength in tension", tensile, "[Pa]");
        prm.add_parameter("Static stress", at_rest, "[Pa]");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const std::string folder = "damped_flow";
        const auto        parameters =
          make_case(file.with({"Output/Folder=" + folder}));
        const auto simulation =
          make_simulation_with_files(*parameters, communicator);
        simulation->run.march();
        MPI_Barrier(communicator);
        const double modulus =
          std::stod(file.given("Materials/rock/Young's modulus"));
        const CsvTable table(folder + "/support_forces.csv");
        const auto     times = table.numbers("time [s]"),
                   forces    = table.numbers("top z [MN]");
        const auto expected =
          forces_of_bar(simulation->run.damping, modulus, times);
        double apart = 0., largest = 0.;
        for (unsigned int i = 0; i < times.size(); ++i)
          {
            keep_largest(apart,
                         std::abs(at_rest + 1e6 * forces[i] - expected[i]));
            keep_largest(largest, std::abs(expected[i]));
          }
        verdicts.below("largest force less that of the strength, share",
                       largest / compressive - 1.,
                       1e-3);
        verdicts.below("difference of the forces over the largest",
                       apart / largest,
                       0.02);

        const CsvTable energy(folder + "/energy.csv");
        double         highest = 0., returned = 0.;
        for (const double loss : energy.numbers("damping [J]"))
          {
            keep_largest(highest, loss);
            keep_largest(returned, highest - loss);
          }
        const double input = energy.numbers("constraints [J]").back();
        verdicts.below("energy that damping returns, over the input",
                       returned / input,
                       1e-3);
        verdicts.below("largest energy-balance error",
                       simulation->run.energy.summary().largest_error,
                       1e-3);
      }

    private:
      /** Forces at these times on a section of 1 m2 and a length of 2 m whose
       *  end moves by -1 mm (1 - cos(4 pi t)) [N]. */
      std::vector<double>
      forces_of_bar(const Damping             &damping,
                    const double               modulus,
                    const std::vector<double> &times) const
      {
        const unsigned int  n = damping.n_branches();
        std::vector<double> filters(n);
        double              relaxed = 1.; // at 3 Hz the modulus is as given
        for (unsigned int i = 0; i < n; ++i)
          {
            const double x = 6. * numbers::PI * damping.relaxation_times[i];
            relaxed += damping.coefficients[i] * x * x / (1. + x * x);
          }
        const double        k = modulus / relaxed, step = 1e-5;
        double              plastic = 0., elastic = 0., stress = at_rest;
        std::vector<double> result;
        unsigned long long  number = 0;
        for (const double time : times)
          {
            for (; step * number < time; ++number)
              {
                const double strain =
                  -5e-4 *
                  (1. - std::cos(4. * numbers::PI * step * (number + 1)));
                // filters and their derivatives by the strain
                double held = 0., stiffness = 1.;
                for (unsigned int i = 0; i < n; ++i)
                  {
                    const double fade =
                      1. / (1. + step / damping.relaxation_times[i]);
                    held +=
                      fade * (filters[i] - damping.coefficients[i] * elastic);
                    stiffness += fade * damping.coefficients[i];
                  }
                stress =
                  std::clamp(at_rest +
                               k * (stiffness * (strain - plastic) + held),
                             -compressive,
                             tensile);
                const double now = ((stress - at_rest) / k - held) / stiffness;
                plastic          = strain - now;
                for (unsigned int i = 0; i < n; ++i)
                  filters[i] =
                    (filters[i] + damping.coefficients[i] * (now - elastic)) /
                    (1. + step / damping.relaxation_times[i]);
                elastic = now;
              }
            result.push_back(stress);
          }
        return result;
      }

      double compressive = 1e6, tensile = 1e6, at_rest = 0.;
    };

    // Reference: closed form
    const Registry<Check>::Add<DampedFlow>
      registered("damped flow", "Plastic flow under Maxwell damping.");
  } // namespace
} // namespace Voussoir
