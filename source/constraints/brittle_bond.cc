#include <voussoir/constraints/interface_law.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A bond that is lost at once when it first opens or slips. */
    class BrittleBond : public InterfaceLaw
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tensile strength",
                          intact.tension,
                          "Normal stress at which the bond breaks [Pa].",
                          Patterns::Double(0.));
        prm.add_parameter("Cohesion",
                          intact.bond,
                          "Shear strength of the bond without pressure [Pa].",
                          Patterns::Double(0.));
        prm.add_parameter("Friction coefficient",
                          intact.friction,
                          "Increase of the shear strength with the pressure.",
                          Patterns::Double(0.));
        prm.add_parameter("Residual cohesion",
                          broken.cohesion,
                          "Shear strength without pressure once the bond is "
                          "lost, while closed [Pa].",
                          Patterns::Double(0.));
        prm.add_parameter("Residual friction coefficient",
                          broken.friction,
                          "Friction once the bond is lost.",
                          Patterns::Double(0.));
      }

      void
      check(const std::string &place) const override
      {
        if (broken.cohesion > intact.bond)
          throw UserError("\"Residual cohesion\" in section \"" + place +
                          "\" is larger than \"Cohesion\"; choose a smaller "
                          "one.");
      }

      InterfaceStrength
      strength(const InterfaceHistory &history) const override
      {
        // round-off, which may be taken for motion, breaks nothing
        constexpr double nanometre = 1e-9;
        return history.opening > nanometre || history.slip > nanometre ?
                 broken :
                 intact;
      }

    private:
      InterfaceStrength intact{1e6, 1e6, 0., 1.}, broken{0., 0., 0., 0.7};
    };

    const Registry<InterfaceLaw>::Add<BrittleBond> registered(
      "brittle bond",
      "Tensile strength and cohesion that are lost at the first motion, then "
      "friction.");
  } // namespace
} // namespace Voussoir
