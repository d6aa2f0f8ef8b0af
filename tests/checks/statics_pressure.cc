#include <voussoir/loads/face_forces.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Force and moment of a depth pressure on an upright face of irregular
     *  cells, at any level that cuts them. */
    class DepthPressure : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto   parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const double width = 10., height = 30., gradient = 9810.;

        double worst_force = 0., worst_moment = 0., crosswise = 0.;
        for (double level = 1.; level <= height; level += 0.725)
          {
            Tensor<1, 3> force;
            double       moment = 0.; // about the base
            for (const auto &[node, part] :
                 depth_pressure_forces(simulation->model.solid.discretization,
                                       {"right"},
                                       "The check",
                                       level,
                                       gradient))
              {
                force += part;
                moment += part[0] * simulation->model.solid.discretization
                                      .node_positions[node][2];
              }
            force  = Utilities::MPI::sum(force, communicator);
            moment = Utilities::MPI::sum(moment, communicator);
            // the face is normal to x
            const double thrust = -0.5 * gradient * level * level * width;
            keep_largest(worst_force, std::abs(force[0] / thrust - 1));
            keep_largest(worst_moment,
                         std::abs(3 * moment / thrust / level - 1));
            crosswise = std::max({crosswise,
                                  std::abs(force[1] / thrust),
                                  std::abs(force[2] / thrust)});
          }
        verdicts.below("relative error of the thrust", worst_force, 1e-8);
        verdicts.below("relative error of its moment", worst_moment, 1e-8);
        verdicts.below("force along the face over thrust", crosswise, 1e-12);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<DepthPressure>
      registered("depth pressure", "Levels that cut cells anywhere.");
  } // namespace
} // namespace Voussoir
