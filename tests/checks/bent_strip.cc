#include <voussoir/fem/point_weights.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A strip of a plate that cannot turn at its left end, nor widen, under
     * shear tractions q of 1 MPa at both ends. With the length L, the thickness
     * h and E' = E/(1 - nu^2) the right end moves, relative to the left one, by
     *
     *   w = 4 q L^3 / (E' h^2) + q L / G .
     *
     * Full integration at degree 1 has, in each of the n cells through the
     * thickness, a strain without the component across the thickness, and a
     * parasitic shear. With the length l of a cell this makes the strip stiffer
     * by
     *
     *   r = 1 - 1/n^2 + (M + G (n l/h)^2) / (n^2 E') ,  M = lambda + 2 G .
     */
    class BentStrip : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tolerance", tolerance, "Relative.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string quadrature : {"one point", "Gauss"})
          for (const std::string poisson : {"0.2", "0.45"})
            for (const unsigned int n : {1, 2})
              {
                const auto parameters = make_case(
                  file.with({"Discretization/Quadrature=" + quadrature,
                             "Materials/stuff/Poisson's ratio=" + poisson,
                             "Mesh/box/Cells=" + std::to_string(length_cells) +
                               ", 1, " + std::to_string(n)}));
                const auto simulation =
                  make_simulation(*parameters, communicator);
                const ElasticConstants c =
                  simulation->model.solid.materials[0]->elastic_constants();
                const double nu      = c.poisson_ratio,
                             modulus = c.young_modulus / (1. - nu * nu),
                             G       = c.shear_modulus(),
                             M = c.lame_lambda() + 2. * G, length = 20.,
                             thickness = 1.,
                             cell      = length / length_cells * n / thickness;
                const double stiffness =
                  quadrature == "Gauss" ?
                    1. + (M + G * cell * cell - modulus) / (n * n * modulus) :
                    1.;
                const double expected =
                  1e6 * (4. * std::pow(length, 3) /
                           (stiffness * modulus * thickness * thickness) +
                         length / G);
                const auto moved =
                  PointWeights(simulation->model.solid.discretization,
                               {{"left", Point<3>()},
                                {"right", Point<3>(length, 0., 0.)}},
                               "")
                    .share(simulation->static_state.initial.displacement);
                const double deflection =
                  Utilities::MPI::sum(moved[1][2] - moved[0][2], communicator);
                verdicts.near(quadrature + ", nu = " + poisson + ", " +
                                std::to_string(n) +
                                " through the thickness: end",
                              1e3 * deflection,
                              1e3 * expected,
                              tolerance,
                              "mm");
              }
      }

    private:
      static constexpr unsigned int length_cells = 10;

      double tolerance = 0.01;
    };

    // Reference: closed form
    const Registry<Check>::Add<BentStrip>
      registered("bent strip", "One point and full integration in bending.");
  } // namespace
} // namespace Voussoir
