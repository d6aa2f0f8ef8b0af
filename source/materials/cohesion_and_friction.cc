#include <voussoir/materials/cohesion_and_friction.h>

namespace Voussoir
{
  using namespace dealii;

  void
  CohesionAndFriction::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Cohesion",
                      cohesion,
                      "Shear strength c without normal stress [Pa].",
                      Patterns::Double(1.));
    prm.add_parameter("Friction angle",
                      friction_angle,
                      "Angle phi of internal friction [degrees].",
                      Patterns::Double(0., 70.));
  }
} // namespace Voussoir
