#include <voussoir/analysis/modal_water.h>
#include <voussoir/fem/nodal_values.h>

#include "rod_and_column.h"
#include "tank.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Added mass of incompressible water in a long channel on a rigid wall. */
    class ModalWaterMass : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto       parameters = make_case(file);
        Tank             tank(*parameters, communicator);
        const ModalWater water(tank.reservoir, 0.);
        Vector motion = tank.discretization.create_vector(), momentum = motion;
        for (unsigned int i = 1; i < motion.locally_owned_size(); i += 3)
          motion.local_element(i) = 1.;
        water.add_momentum(momentum, nullptr, motion, nullptr);

        double height = 0., width = 0.;
        for (const auto &x : tank.water_mesh.vertices)
          {
            keep_largest(height, x[2]);
            keep_largest(width, 2. * x[0]);
          }
        // sum of 8/pi^2 sin(n pi h/2H)/n^2 over odd n, and its integral
        double total = 0., base = 0.;
        for (unsigned int n = 1; n < 2000; n += 2)
          {
            total += 16. / std::pow(n * numbers::PI, 3);
            base += 8. / std::pow(n * numbers::PI, 2) *
                    std::sin(0.5 * n * numbers::PI);
          }
        const double density = parameters->reservoir.density;
        verdicts.near("added mass / rho H^2",
                      resultant_along_y(momentum) /
                        (density * height * height * width),
                      total,
                      tolerance);
        verdicts.near("the series of it", total, 0.5428, 1e-4);
        verdicts.near("pressure at the base / rho a H",
                      pressure_at_base(tank, momentum) / (density * height),
                      base,
                      tolerance);
        verdicts.near("the series of it", base, 0.7425, 1e-4);

        // of two motions
        Vector other = motion, other_momentum = motion;
        for (unsigned int node = 0; node < tank.discretization.n_owned_nodes();
             ++node)
          other.local_element(3 * node + 1) =
            std::sin(0.03 * tank.discretization.node_positions[node][2]);
        other_momentum = 0.;
        water.add_momentum(other_momentum, nullptr, other, nullptr);
        const double ab = momentum * other, ba = other_momentum * motion;
        verdicts.below("asymmetry", ab / ba - 1., 1e-9);
      }

      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tolerance", tolerance, "Relative.");
      }

    private:
      static double
      resultant_along_y(const Vector &momentum)
      {
        double sum = 0.;
        for (unsigned int i = 1; i < momentum.locally_owned_size(); i += 3)
          sum += momentum.local_element(i);
        return Utilities::MPI::sum(sum, momentum.get_mpi_communicator());
      }

      /** Force over area of a node at the base, where both are halved. */
      static double
      pressure_at_base(const Tank &tank, const Vector &momentum)
      {
        double force = 0., area = 0.;
        for (const Reservoir::Pair &pair : tank.reservoir.pairs)
          if (tank.discretization.node_positions[pair.node][2] < 1e-9)
            {
              force += std::abs(momentum.local_element(3 * pair.node + 1));
              area += pair.area.norm();
            }
        return Utilities::MPI::sum(force, momentum.get_mpi_communicator()) /
               Utilities::MPI::sum(area, momentum.get_mpi_communicator());
      }

      double tolerance = 0.005;
    };

    // Reference: closed form
    const Registry<Check>::Add<ModalWaterMass>
      registered_mass("modal water mass", "On a rigid wall.");


    class RodAndWater : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Rod", length, "Its length [m].");
        prm.add_parameter("Water", depth, "Height of the column [m].");
        prm.add_parameter("Area", area, "Of both [m2].");
        prm.add_parameter("Tolerance", tolerance, "Relative.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string water : {"incompressible", "compressible"})
          {
            const auto parameters =
              make_case(file.with({"Modes/Water=" + water}));
            const auto simulation = make_simulation(*parameters, communicator);
            const Modes       &modes = simulation->modes;
            const RodAndColumn exact{
              simulation->model.solid.materials[0]->elastic_constants(),
              length,
              depth,
              parameters->reservoir.density,
              water == "compressible" ? parameters->reservoir.sound_speed :
                                        1e8};
            const std::vector<double> frequencies =
              exact.frequencies(parameters->modes.number);
            for (unsigned int j = 0; j < frequencies.size(); ++j)
              {
                const std::string name =
                  water + " water, mode " + std::to_string(j + 1);
                verdicts.near(name,
                              2. * numbers::PI * modes.list[j].frequency,
                              frequencies[j],
                              tolerance,
                              "rad/s");
                verdicts.near(name + ", effective mass",
                              1e-3 * modes.list[j].effective_mass[2] / area,
                              1e-3 * exact.effective_mass(frequencies[j]),
                              10. * tolerance,
                              "t/m2");
              }
            verdicts.near(water + " water, moving mass",
                          1e-3 * modes.moving_mass[2],
                          1e-3 *
                            (resultant(simulation->model.solid.mass.mass)[2] +
                             exact.density * depth * area),
                          1e-8,
                          "t");
          }
      }

    private:
      double length = 0., depth = 0., area = 1., tolerance = 1e-3;
    };

    // Reference: closed form
    const Registry<Check>::Add<RodAndWater>
      registered_rod("modes of rod and water", "In closed form.");


    /**
     * Water between rigid walls, H deep, L long, with a free surface:
     *   f = c/4H sqrt((2m - 1)^2 + (2 n H/L)^2) .
     */
    class ChannelModes : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Depth", depth, "H [m].");
        prm.add_parameter("Length", length, "L [m].");
        prm.add_parameter("Tolerance", tolerance, "Relative.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        std::vector<double> expected;
        for (unsigned int m = 1; m < 20; m += 2)
          for (unsigned int n = 0; n < 20; ++n)
            expected.push_back(parameters->reservoir.sound_speed /
                               (4. * depth) *
                               std::hypot(m, 2. * n * depth / length));
        std::sort(expected.begin(), expected.end());
        for (unsigned int j = 0; j < parameters->modes.number; ++j)
          verdicts.near("mode " + std::to_string(j + 1),
                        simulation->modes.list[j].frequency,
                        expected[j],
                        tolerance,
                        "Hz");
      }

    private:
      double depth = 0., length = 0., tolerance = 1e-3;
    };

    // Reference: closed form
    const Registry<Check>::Add<ChannelModes>
      registered_channel("channel modes", "Of water between rigid walls.");
  } // namespace
} // namespace Voussoir
