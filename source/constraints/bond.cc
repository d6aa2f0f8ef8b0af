#include <voussoir/base/error.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/constraints/bond.h>

namespace Voussoir
{
  using namespace dealii;

  void
  Bond::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Tensile strength",
                      intact.tension,
                      "Normal stress at which the bond begins to open [Pa]." +
                        usually(Usual::interface_tension),
                      Patterns::Double(0.));
    prm.add_parameter("Cohesion",
                      intact.bond,
                      "Shear strength of the bond without pressure [Pa]." +
                        usually(Usual::interface_cohesion),
                      Patterns::Double(0.));
    prm.add_parameter("Friction coefficient",
                      intact.friction,
                      "Increase of the shear strength with the pressure [-]." +
                        usually(Usual::friction_coefficient),
                      Patterns::Double(0.));
    prm.add_parameter(
      "Residual cohesion",
      broken.cohesion,
      "Shear strength without pressure once the bond is lost, while the "
      "interface is closed [Pa]." +
        usually(Usual::interface_cohesion),
      Patterns::Double(0.));
    prm.add_parameter("Residual friction coefficient",
                      broken.friction,
                      "Friction coefficient once the bond is lost [-]." +
                        usually(Usual::friction_coefficient),
                      Patterns::Double(0.));
  }


  void
  Bond::check(const std::string &place) const
  {
    if (broken.cohesion > intact.bond)
      throw UserError("\"Residual cohesion\" in section \"" + place +
                      "\" is larger than \"Cohesion\"; choose a smaller one.");
  }
} // namespace Voussoir
