#include <voussoir/base/usual_range.h>
#include <voussoir/materials/cohesion_and_friction.h>

namespace Voussoir
{
  using namespace dealii;

  void
  CohesionAndFriction::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Cohesion",
                      cohesion,
                      "Shear strength c without normal stress [Pa]." +
                        usually(Usual::cohesion),
                      Patterns::Double(1.));
    prm.add_parameter("Friction angle",
                      friction_angle,
                      "Angle phi of internal friction [degrees]." +
                        usually(Usual::friction_angle),
                      Patterns::Double(0., 70.));
  }
} // namespace Voussoir
