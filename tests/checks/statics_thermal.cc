#include <voussoir/base/mpi.h>
#include <voussoir/fem/nodal_values.h>
#include <voussoir/fem/point_weights.h>

#include <deal.II/fe/fe_values.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Bodies whose temperature changes uniformly by dT0, or linearly by dT0
     * from the back to the front face, supported by planes of symmetry:
     *
     * - free bar: u = alpha dT0 x, no stress
     * - clamped bar: no displacement along it, sigma_xx = -E alpha dT0
     * - plate, y from its middle, thickness T, k = -alpha dT0 / T:
     *     u = k (x y, (y^2 - x^2 - z^2)/2, z y), no stress
     */
    class Thermal : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Body",
                          body,
                          "Which.",
                          Patterns::Selection("free bar|clamped bar|plate"));
        prm.add_parameter("Change", change, "dT0 [K].");
        prm.add_parameter("Tolerance", tolerance, "Relative.");
        prm.add_parameter("Stress tolerance",
                          stress_tolerance,
                          "Largest stress over E alpha dT0.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto   parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const auto  &material   = *simulation->model.solid.materials[0];
        const double E          = material.elastic_constants().young_modulus *
                         material.static_factor,
                     strain = material.expansion * change;

        const auto error = displacement_error(*simulation, strain);
        verdicts.below("displacement against closed form, over the largest",
                       error,
                       tolerance);
        if (body == "plate")
          verdicts.near("deflection over closed form",
                        deflection(*simulation, strain),
                        1.,
                        tolerance);
        const auto [smallest, largest] = stress_range(*simulation);
        if (body == "clamped bar")
          {
            verdicts.near("smallest stress along the bar",
                          1e-6 * smallest,
                          -1e-6 * E * strain,
                          tolerance,
                          "MPa");
            verdicts.near("largest stress along the bar",
                          1e-6 * largest,
                          -1e-6 * E * strain,
                          tolerance,
                          "MPa");
          }
        else
          verdicts.below("largest stress over E alpha dT",
                         std::max(-smallest, largest) / (E * strain),
                         stress_tolerance);
      }

    private:
      Tensor<1, 3>
      exact(const Point<3> &x, const double strain) const
      {
        if (body == "clamped bar")
          return {};
        if (body == "free bar")
          return strain * x;
        // from the back face at y = 1 to the front face at y = -1
        const double k = -0.5 * strain;
        return Tensor<1, 3>(
          {k * x[0] * x[1],
           0.5 * k * (x[1] * x[1] - x[0] * x[0] - x[2] * x[2]),
           k * x[2] * x[1]});
      }

      /** Largest difference over the largest displacement; of the clamped bar
       *  only along it, over its free expansion. */
      double
      displacement_error(const Simulation &simulation,
                         const double      strain) const
      {
        const Discretization &discretization =
          simulation.model.solid.discretization;
        const Vector displacement = // also of hanging nodes
          with_ghosts(discretization,
                      simulation.static_state.initial.displacement);
        const unsigned int n = discretization.n_owned_nodes();
        // the plate is not supported across: its mean is set to the exact one
        std::vector<double> sums(2);
        for (unsigned int node = 0; node < n; ++node)
          {
            sums[0] += node_value(displacement, node)[1] -
                       exact(discretization.node_positions[node], strain)[1];
            sums[1] += 1.;
          }
        sums = sum_over_ranks(sums, simulation.model.grid.communicator());
        const double shift = body == "plate" ? sums[0] / sums[1] : 0.;

        double difference = 0., size = 0.;
        for (unsigned int node = 0; node < n; ++node)
          {
            const Point<3> &x = discretization.node_positions[node];
            Tensor<1, 3>    u = node_value(displacement, node),
                         e    = exact(x, strain);
            u[1] -= shift;
            if (body == "clamped bar")
              {
                keep_largest(difference, std::abs(u[0]));
                keep_largest(size, strain * x.norm());
              }
            else
              {
                keep_largest(difference, (u - e).norm());
                keep_largest(size, e.norm());
              }
          }
        const MPI_Comm communicator = simulation.model.grid.communicator();
        return Utilities::MPI::max(difference, communicator) /
               Utilities::MPI::max(size, communicator);
      }

      /** Of the plate: displacement across at the far corner less that at the
       *  middle, over the exact one. */
      double
      deflection(const Simulation &simulation, const double strain) const
      {
        const std::vector<NamedPoint> points{{"middle", Point<3>()},
                                             {"corner",
                                              Point<3>(10., 0., 10.)}};
        const auto                    share =
          PointWeights(simulation.model.solid.discretization, points, "")
            .share(simulation.static_state.initial.displacement);
        return Utilities::MPI::sum(share[1][1] - share[0][1],
                                   simulation.model.grid.communicator()) /
               exact(points[1].position, strain)[1];
      }

      /** Smallest and largest stress: along the bar if it is clamped, else of
       *  all components, at the integration points. */
      std::pair<double, double>
      stress_range(const Simulation &simulation) const
      {
        const Discretization &discretization =
          simulation.model.solid.discretization;
        const Vector u =
          with_ghosts(discretization,
                      simulation.static_state.initial.displacement);
        const Vector temperature =
          with_ghosts(discretization,
                      simulation.static_state.initial.temperature);
        FEValues<3>                        values(discretization.mapping,
                           discretization.fe,
                           discretization.matrix_free.quadrature,
                           update_values | update_gradients);
        const FEValuesExtractors::Vector   all(0);
        std::vector<SymmetricTensor<2, 3>> strains(values.n_quadrature_points);
        std::vector<Tensor<1, 3>> temperatures(values.n_quadrature_points);
        double                    smallest = 1e300, largest = -1e300;
        for (const auto &cell :
             discretization.dof_handler.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              values.reinit(cell);
              values[all].get_function_symmetric_gradients(u, strains);
              values[all].get_function_values(temperature, temperatures);
              for (const unsigned int q : values.quadrature_point_indices())
                {
                  const auto &material = *simulation.model.solid.materials[0];
                  const auto  stress = material.stress(material.elastic_strain(
                    strains[q], strains[q], temperatures[q][0], 1.));
                  for (unsigned int i = 0; i < (body == "clamped bar" ? 1 : 6);
                       ++i)
                    {
                      const double s = stress.access_raw_entry(i);
                      keep_smallest(smallest, s);
                      keep_largest(largest, s);
                    }
                }
            }
        const MPI_Comm communicator = simulation.model.grid.communicator();
        return {Utilities::MPI::min(smallest, communicator),
                Utilities::MPI::max(largest, communicator)};
      }

      std::string body      = "free bar";
      double      change    = 0.;
      double      tolerance = 1e-6, stress_tolerance = 1e-6;
    };

    // Reference: closed form
    const Registry<Check>::Add<Thermal>
      registered("thermal", "Expansion, constrained expansion, bending.");
  } // namespace
} // namespace Voussoir
