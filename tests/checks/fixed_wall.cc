#include <voussoir/fem/face_nodes.h>
#include <voussoir/fem/named_sets.h>
#include <voussoir/fem/nodal_values.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A dam on a floor that is fixed and wet, as the walls of a canyon are:
     * where the ground rises with unit acceleration, the pressure of the water
     * between walls that all rise is p = rho (H - z), for any shape of the
     * walls. The modes take part by phi^T M r + int p phi . n dA , n out of the
     * dam, as inertia and this pressure both act on the dam. Through the water
     * the motion of the floor excites the modes, unlike a motion of the dam
     * alone.
     */
    class FixedWall : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Level", level, "Level of the water [m].");
        prm.add_parameter("Face sets", faces, "Wet faces of the dam.");
        prm.add_parameter("Tolerance", tolerance, "Relative.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto   parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const Modes &modes      = simulation->modes;
        double       sum        = 0.;
        for (unsigned int j = 0; j < modes.list.size(); ++j)
          {
            const Mode &mode = modes.list[j];
            sum += mode.effective_mass[2] / modes.moving_mass[2];
            const double dry = factor_of_solid(*simulation, mode, communicator),
                         wet = dry + factor_of_water(*simulation,
                                                     *parameters,
                                                     mode,
                                                     communicator);
            if (j > 3)
              continue;
            const std::string name = "mode " + std::to_string(j + 1);
            verdicts.near(name + ": participation upwards, phi^T M r / mass",
                          mode.participation[2],
                          wet / mode.mass,
                          tolerance);
            verdicts.near("  effective mass",
                          1e-6 * mode.effective_mass[2],
                          1e-6 * wet * wet / mode.mass,
                          2. * tolerance,
                          "kt");
            verdicts.above("  share of the water in it",
                           std::abs(wet / dry - 1.),
                           0.01);
          }
        verdicts.above("cumulative effective mass of the modes", sum, 0.7);
        verdicts.above("  less than all", 1. - sum, 0.);
      }

    private:
      /** phi^T M r. */
      static double
      factor_of_solid(const Simulation &simulation,
                      const Mode       &mode,
                      const MPI_Comm    communicator)
      {
        const Vector &mass = simulation.model.solid.mass.mass;
        double        sum  = 0.;
        for (unsigned int i = 2; i < mass.locally_owned_size(); i += 3)
          sum += mass.local_element(i) * mode.shape.local_element(i);
        return Utilities::MPI::sum(sum, communicator);
      }

      /** int p phi . n dA; fixed nodes do not move in a mode. */
      double
      factor_of_water(const Simulation &simulation,
                      const Case       &parameters,
                      const Mode       &mode,
                      const MPI_Comm    communicator) const
      {
        const Discretization &discretization =
          simulation.model.solid.discretization;
        FaceNodes face_nodes(discretization.mapping,
                             discretization.fe.base_element(0));
        Vector    shape(mode.shape);
        shape.update_ghost_values();
        double sum = 0.;
        for_each_face(discretization,
                      split_list(faces),
                      "Face sets",
                      [&](const auto &cell, const unsigned int face) {
                        const auto nodes = discretization.cell_nodes(
                          discretization.dof_cell(cell));
                        for (const FaceNode &node : face_nodes.of(cell, face))
                          for (unsigned int d = 0; d < 3; ++d)
                            sum += parameters.reservoir.density *
                                   positive_part(level - node.position[2]) *
                                   node.area * node.normal[d] *
                                   shape(3 * nodes[node.number] + d);
                      });
        return Utilities::MPI::sum(sum, communicator);
      }

      double      level = 0., tolerance = 0.01;
      std::string faces = "upstream face";
    };

    // Reference: closed form
    const Registry<Check>::Add<FixedWall>
      registered("fixed wall",
                 "Water that a fixed floor pushes, in the modes.");
  } // namespace
} // namespace Voussoir
