#include <voussoir/fem/point_weights.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Displacements of the static stage at a point against given ones. */
    class StaticDisplacement : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Point", point, "Where [m].");
        prm.add_parameter("Along the river",
                          along,
                          "Expected [mm]; 0: not known.");
        prm.add_parameter("Upwards", upwards, "Expected [mm]; 0: not known.");
        prm.add_parameter("Tolerance", tolerance, "Relative.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        const PointWeights weights(simulation->model.solid.discretization,
                                   {{"point", point}},
                                   "Point");
        const Tensor<1, 3> displacement = Utilities::MPI::sum(
          weights.share(simulation->static_state.initial.displacement)[0],
          communicator);
        if (along != 0.)
          verdicts.near(
            "along the river", 1e3 * displacement[1], along, tolerance, "mm");
        if (upwards != 0.)
          verdicts.near(
            "upwards", 1e3 * displacement[2], upwards, tolerance, "mm");
      }

    private:
      Point<3> point;
      double   along = 0., upwards = 0., tolerance = 0.01;
    };

    // Reference: other program
    const Registry<Check>::Add<StaticDisplacement>
      registered("static displacement", "Under loads, against known values.");
  } // namespace
} // namespace Voussoir
