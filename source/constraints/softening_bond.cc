#include <voussoir/base/usual_range.h>
#include <voussoir/constraints/bond.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A bond that softens linearly: with w the largest opening and s the
     * accumulated slip, the share of its strength that is left is
     *   (1 - w ft / (2 GfI)) (1 - s (c - c_res) / (2 GfII)) ,
     * which takes GfI per area in pure opening and GfII in pure slip.
     */
    class SofteningBond : public Bond
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        Bond::declare_parameters(prm);
        prm.add_parameter("Fracture energy",
                          opening_energy,
                          "Fracture energy in opening, per area (GfI) [J/m2]." +
                            usually(Usual::fracture_energy),
                          Patterns::Double(1e-3));
        prm.add_parameter(
          "Shear fracture energy",
          slip_energy,
          "Fracture energy in shear, per area and without the work of the "
          "residual strength (GfII) [J/m2]." +
            usually(Usual::shear_fracture_energy),
          Patterns::Double(1e-3));
      }

      InterfaceStrength
      strength(const InterfaceHistory &history) const override
      {
        const double lost_cohesion = intact.bond - broken.cohesion;
        const double whole =
          std::max(0.,
                   1. -
                     0.5 * history.opening * intact.tension / opening_energy) *
          std::max(0., 1. - 0.5 * history.slip * lost_cohesion / slip_energy);
        // the residual strength acts from the start
        return {intact.tension * whole,
                lost_cohesion * whole,
                broken.cohesion,
                broken.friction + (intact.friction - broken.friction) * whole};
      }

    private:
      double opening_energy = 200., slip_energy = 2000.;
    };

    const Registry<InterfaceLaw>::Add<SofteningBond> registered_softening_bond(
      "softening bond",
      "Tensile strength and cohesion that soften with opening and slip at "
      "given fracture energies, then friction.");
  } // namespace
} // namespace Voussoir
