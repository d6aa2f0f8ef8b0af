#include <voussoir/base/usual_range.h>
#include <voussoir/constraints/bond.h>
#include <voussoir/fem/crack_growth.h>

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
     * which takes GfI per area in pure opening and GfII in pure slip. At the
     * tip of a crack the strength has a factor f, and the openings and slips
     * 1/f, which keeps both energies.
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
        add_option(
          prm,
          "Crack growth",
          growth,
          "Whether a point cracks by the strength of the bond alone, or "
          "beside a cracked point by the lower strength ft / "
          "sqrt(1 + h ft^2 / (E Gf)) at a distance h of these points, with which "
          "cracks propagate at about the load of fracture mechanics in cells of "
          "any size. \"Local\" lets them propagate at too high a load where h is "
          "not much smaller than E Gf / ft^2.",
          {CrackGrowth::local, CrackGrowth::from_tips});
      }

      bool
      grows_from_tips() const override
      {
        return growth == CrackGrowth::from_tips;
      }

      double
      tip_strength(const double distance,
                   const double young_modulus) const override
      {
        return strength_at_tip(distance,
                               young_modulus * opening_energy /
                                 (intact.tension * intact.tension));
      }

      InterfaceStrength
      strength(const InterfaceHistory &history) const override
      {
        const double tension = history.tip * intact.tension,
                     lost_cohesion =
                       history.tip * (intact.bond - broken.cohesion);
        const double whole =
          std::max(0., 1. - 0.5 * history.opening * tension / opening_energy) *
          std::max(0., 1. - 0.5 * history.slip * lost_cohesion / slip_energy);
        // the residual strength acts from the start
        return {tension * whole,
                lost_cohesion * whole,
                broken.cohesion,
                broken.friction + (intact.friction - broken.friction) * whole};
      }

    private:
      double      opening_energy = 200., slip_energy = 2000.;
      CrackGrowth growth = CrackGrowth::from_tips;
    };

    const Registry<InterfaceLaw>::Add<SofteningBond> registered_softening_bond(
      "softening bond",
      "Tensile strength and cohesion that soften with opening and slip at "
      "given fracture energies, then friction.");
  } // namespace
} // namespace Voussoir
