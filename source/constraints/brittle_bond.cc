#include <voussoir/constraints/bond.h>

namespace Voussoir
{
  namespace
  {
    /** A bond that is lost at once when it first opens or slips. */
    class BrittleBond : public Bond
    {
    public:
      InterfaceStrength
      strength(const InterfaceHistory &history) const override
      {
        // round-off must not break the bond
        constexpr double nanometre = 1e-9;
        return history.opening > nanometre || history.slip > nanometre ?
                 broken :
                 intact;
      }
    };

    const Registry<InterfaceLaw>::Add<BrittleBond> registered_brittle_bond(
      "brittle bond",
      "Tensile strength and cohesion that are lost at the first opening or "
      "slip, then friction.");
  } // namespace
} // namespace Voussoir
