#include "check.h"
#include "histories.h"
#include "rod_and_column.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A rod and a column of water vibrate after an impact at the frequencies
     *  of their common modes. */
    class RodAndWaterMotion : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Rod", length, "Its length [m].");
        prm.add_parameter("Water", depth, "Height of the column [m].");
        prm.add_parameter("Modes", n_modes, "Looked at.");
        prm.add_parameter("Tolerance", tolerance, "Relative.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        const RodAndColumn exact{
          simulation->model.solid.materials[0]->elastic_constants(),
          length,
          depth,
          parameters->reservoir.density,
          parameters->reservoir.sound_speed};

        Vector     &velocity = simulation->run.state.velocity;
        const auto &nodes =
          simulation->model.solid.discretization.node_positions;
        for (unsigned int i = 0; i < velocity.locally_owned_size() / 3; ++i)
          velocity.local_element(3 * i + 2) = std::pow(nodes[i][2] / length, 2);
        const Histories histories =
          run_and_record(*simulation, {{"wet end", Point<3>(0., 0., length)}});

        // through Hann's window modes do not interfere
        std::vector<double> values = histories.component(0, 2);
        const double        end    = histories.times.back();
        for (unsigned int i = 0; i < values.size(); ++i)
          values[i] *=
            1. - std::cos(2. * numbers::PI * histories.times[i] / end);
        for (unsigned int j = 0; j < n_modes; ++j)
          {
            const double expected =
              exact.frequencies(n_modes)[j] / (2. * numbers::PI);
            double found = 0., largest = 0.;
            for (double ratio = 0.95; ratio < 1.05; ratio += 1e-4)
              {
                const double size = std::abs(fourier_sum(
                  histories.times, values, ratio * expected, 0., end));
                if (size > largest)
                  {
                    largest = size;
                    found   = ratio * expected;
                  }
              }
            verdicts.near("frequency " + std::to_string(j + 1),
                          found,
                          expected,
                          tolerance,
                          "Hz");
          }
      }

    private:
      double       length = 0., depth = 0., tolerance = 1e-3;
      unsigned int n_modes = 1;
    };

    // Reference: closed form
    const Registry<Check>::Add<RodAndWaterMotion>
      registered("motion of rod and water", "Frequencies in the time domain.");
  } // namespace
} // namespace Voussoir
