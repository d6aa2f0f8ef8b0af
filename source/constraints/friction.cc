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
        prm.add_parameter("Friction coefficient",
                          constant.friction,
                          "Shear over pressure at which it slips.",
                          Patterns::Double(0.));
        prm.add_parameter("Cohesion",
                          constant.cohesion,
                          "Shear strength without pressure, while closed; it "
                          "is never lost [Pa].",
                          Patterns::Double(0.));
      }

      InterfaceStrength
      strength(const InterfaceHistory &) const override
      {
        return constant;
      }

    private:
      InterfaceStrength constant{0., 0., 0., 0.7};
    };

    const Registry<InterfaceLaw>::Add<Friction>
      registered("friction", "Coulomb friction without bond.");
  } // namespace
} // namespace Voussoir
