#include <deal.II/base/function.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/numerics/vector_tools.h>

#include <iomanip>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** sin(5 pi z/2) cos(w t) in the z component of a column of height 1. */
    class StandingWave : public Function<3>
    {
    public:
      StandingWave()
        : Function<3>(3)
      {}

      static constexpr double wave_number = 2.5 * numbers::PI;

      double factor = 1.;

      double
      value(const Point<3> &p, const unsigned int component) const override
      {
        return component == 2 ? factor * std::sin(wave_number * p[2]) : 0.;
      }
    };


    /**
     * Standing plane P wave in a laterally constrained column with fixed base:
     * the error in space falls with the power degree + 1 of the cell size. The
     * known error of the time integration is eliminated by comparison with the
     * frequency of the scheme, sin(w' dt/2) = w dt/2.
     */
    class Convergence : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Coarse", coarse, "Cells in the first mesh.");
        prm.add_parameter("Fine", fine, "Cells in the second mesh.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (unsigned int degree = 1; degree <= 4; ++degree)
          {
            // degree 1 reaches its order on finer meshes only
            const unsigned int more = degree == 1 ? 4 : 1;
            const double       first =
              error(file, degree, more * coarse, communicator);
            const double second =
              error(file, degree, more * fine, communicator);
            const double order = std::log(first / second) /
                                 std::log(double(fine) / double(coarse));
            verdicts.above("order of convergence, degree " +
                             std::to_string(degree),
                           order,
                           degree + 0.9);
          }
      }

    private:
      double
      error(const ParameterFile &file,
            const unsigned int   degree,
            const unsigned int   cells,
            const MPI_Comm       communicator) const
      {
        const std::string width      = std::to_string(1. / cells);
        const auto        parameters = make_case(
          file.with({"Discretization/Degree=" + std::to_string(degree),
                            "Mesh/box/Cells=1, 1, " + std::to_string(cells),
                            "Mesh/box/Upper corner=" + width + "," + width + ",1"}));
        const auto   simulation = make_simulation(*parameters, communicator);
        State       &state      = simulation->run.state;
        const double dt         = simulation->run.time_step.length;
        const double omega =
          StandingWave::wave_number * simulation->model.solid.materials[0]
                                        ->elastic_constants()
                                        .p_wave_speed();
        const double discrete = 2. / dt * std::asin(0.5 * omega * dt);

        StandingWave exact;
        for (unsigned int node = 0;
             node < simulation->model.solid.discretization.n_owned_nodes();
             ++node)
          if (simulation->model.solid.mass.inverse.local_element(3 * node + 2) >
              0.)
            {
              const double u = exact.value(
                simulation->model.solid.discretization.node_positions[node], 2);
              state.displacement.local_element(3 * node + 2) = u;
              state.velocity.local_element(3 * node + 2) =
                (1. - std::cos(discrete * dt)) / dt * u;
            }
        // slightly more than one period
        while (state.time < 7. / omega)
          simulation->run.scheme.step(state);
        exact.factor = std::cos(discrete * state.time);
        state.displacement.update_ghost_values();
        dealii::Vector<double> differences(
          simulation->model.grid.triangulation().n_active_cells());
        VectorTools::integrate_difference(
          simulation->model.solid.discretization.mapping,
          simulation->model.solid.discretization.dof_handler,
          state.displacement,
          exact,
          differences,
          QGauss<3>(degree + 3),
          VectorTools::L2_norm);
        // per root of the volume, as the column is one cell wide
        return cells * VectorTools::compute_global_error(
                         simulation->model.grid.triangulation(),
                         differences,
                         VectorTools::L2_norm);
      }

      unsigned int coarse = 6, fine = 12;
    };

    // Reference: closed form
    const Registry<Check>::Add<Convergence>
      registered("convergence", "Order in space of degrees 1 to 4.");
  } // namespace
} // namespace Voussoir
