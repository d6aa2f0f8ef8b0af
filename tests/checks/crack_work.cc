#include <voussoir/fem/nodal_values.h>

#include "march_with_energy.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A bar along z with a weak layer is pulled apart slowly, without damping,
     * between linear elastic parts that show its traction by their elongation.
     * The loss that the law reports is the work of the traction on the
     * opening of the layer.
     */
    class CrackWork : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Planes",
                          planes,
                          "Ends of an elastic part and of the layer [m].");
        prm.add_parameter("Area", area, "Area of the bar [m2].");
        prm.add_parameter("Tolerances", tolerances, "For each law.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const std::vector<std::string> laws{"concrete damage",
                                            "rock damage",
                                            "lee-fenves",
                                            "mazars"};
        for (unsigned int l = 0; l < laws.size(); ++l)
          {
            const auto parameters =
              make_case(file.with({"Materials/weak/Class=" + laws[l]}));
            const auto simulation = make_simulation(*parameters, communicator);
            Run       &run        = simulation->run;
            const double modulus  = simulation->model.solid.materials[0]
                                     ->elastic_constants()
                                     .young_modulus;
            double work = 0., traction = 0., opening = 0., largest = 0.;
            march_with_energy(run, [&](const bool) {
              const auto   u = mean_displacement(*simulation, communicator);
              const double now =
                             modulus * (u[1] - u[0]) / (planes[1] - planes[0]),
                           open = u[3] - u[2] -
                                  now / modulus * (planes[3] - planes[2]);
              work += 0.5 * area * (traction + now) * (open - opening);
              traction = now;
              opening  = open;
              keep_largest(largest, now);
            });
            verdicts.below(laws[l] + ": traction left over the largest",
                           traction / largest,
                           0.02);
            verdicts.near("  lost by the law, and work of the traction",
                          run.energy.latest().material,
                          work,
                          tolerances[l],
                          "J");
            verdicts.below("  largest energy-balance error over the input",
                           run.energy.summary().largest_error,
                           tolerances[l]);
          }
      }

    private:
      /** Displacement along z of the nodes in each plane. */
      std::vector<double>
      mean_displacement(const Simulation &simulation,
                        const MPI_Comm    communicator) const
      {
        const Discretization &space = simulation.model.solid.discretization;
        std::vector<double>   sums(2 * planes.size());
        for (unsigned int node = 0; node < space.n_owned_nodes(); ++node)
          for (unsigned int p = 0; p < planes.size(); ++p)
            if (std::abs(space.node_positions[node][2] - planes[p]) < 1e-6)
              {
                sums[2 * p] +=
                  node_value(simulation.run.state.displacement, node)[2];
                sums[2 * p + 1] += 1.;
              }
        std::vector<double> of_all(sums.size()), result;
        Utilities::MPI::sum(sums, communicator, of_all);
        for (unsigned int p = 0; p < planes.size(); ++p)
          result.push_back(of_all[2 * p] / of_all[2 * p + 1]);
        return result;
      }

      std::vector<double> planes, tolerances;
      double              area = 0.;
    };

    // Reference: closed form
    const Registry<Check>::Add<CrackWork>
      registered("crack work", "A law's loss is traction times opening.");
  } // namespace
} // namespace Voussoir
