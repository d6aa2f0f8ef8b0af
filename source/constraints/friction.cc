#include <voussoir/base/usual_range.h>
#include <voussoir/constraints/interface_law.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Dry friction: an open joint, or a plane that has slipped before. */
    class Friction : public InterfaceLaw
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Friction coefficient",
          constant.friction,
          "Friction coefficient: shear over pressure at which the interface "
          "slips [-]." +
            usually(Usual::friction_coefficient),
          Patterns::Double(0.));
        prm.add_parameter(
          "Cohesion",
          constant.cohesion,
          "Shear strength without pressure, while closed; it is kept during "
          "slip, and lost where the interface has been open by more than 0.01 "
          "mm [Pa]." +
            usually(Usual::interface_cohesion),
          Patterns::Double(0.));
      }

      InterfaceStrength
      strength(const InterfaceHistory &history) const override
      {
        // asperities still interlock across a hundredth of a millimetre
        constexpr double parted = 1e-5;

        InterfaceStrength now = constant;
        if (history.opening > parted)
          now.cohesion = 0.;
        return now;
      }

    private:
      InterfaceStrength constant{0., 0., 0., 0.7};
    };

    const Registry<InterfaceLaw>::Add<Friction>
      registered_friction("friction", "Coulomb friction without bond.");
  } // namespace
} // namespace Voussoir
