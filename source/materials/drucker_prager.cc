// Rock that yields on a cone.

#include <voussoir/base/option.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/materials/material_of.h>
#include <voussoir/materials/perfect_plasticity.h>
#include <voussoir/materials/spectral.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    enum class ConeFit
    {
      compression,
      plane_strain
    };

    OptionNames<ConeFit>
    option_names(const ConeFit)
    {
      return {{ConeFit::compression, "compression"},
              {ConeFit::plane_strain, "plane strain"}};
    }


    /**
     * Drucker and Prager (1952) with tension cut-off,
     *   sqrt(J2) + a I1 <= k ,   I1 <= 3 pt .
     * Plastic flow is along the gradient of sqrt(J2) + a' I1 on the cone and of
     * I1 on the cut-off. The cut-off lies at or before the apex of the cone, so
     * that the return to their edge includes the return to the apex.
     */
    struct DruckerPrager : PerfectPlasticity
    {
      ConeFit fit = ConeFit::compression;

      double slope      = 0.; // a
      double limit      = 0.; // k [Pa]
      double flow_slope = 0.; // a'
      double end        = 0.; // largest I1 [Pa]

      void
      declare_parameters(ParameterHandler &prm)
      {
        PerfectPlasticity::declare_parameters(prm);
        prm.add_parameter("Tension cut-off",
                          cut_off,
                          "Largest mean stress [Pa]; beyond the apex of the "
                          "cone it has no effect." +
                            usually(Usual::cut_off),
                          Patterns::Double(1.));
        add_option(
          prm,
          "Fit",
          fit,
          "State of stress in which the cone is as strong as the Mohr-Coulomb "
          "law of the same cohesion and angles: triaxial compression, or "
          "plane strain with equal angles of friction and dilation. The "
          "second cone is nowhere stronger.");
      }

      /** Slope of the cone of an angle, and k / c. */
      std::pair<double, double>
      cone(const double degrees) const
      {
        const double angle = degrees * numbers::PI / 180.,
                     sine  = std::sin(angle);
        const double scale = fit == ConeFit::compression ?
                               std::sqrt(3.) * (3. - sine) / 2. :
                               std::sqrt(9. + 3. * sine * sine);
        return {sine / scale, 3. * std::cos(angle) / scale};
      }

      void
      check(const std::string &place)
      {
        PerfectPlasticity::check(place);
        slope      = cone(friction_angle).first;
        limit      = cone(friction_angle).second * cohesion;
        flow_slope = cone(dilation_angle).first;
        end        = 3. * cut_off;
        if (slope * end > limit)
          end = limit / slope;
      }

      template <typename Number>
      Number
      yield_ratio(const SymmetricTensor3<Number> &stress, const Number &) const
      {
        const auto [first, second] = invariants(stress);
        return std::max(Number((std::sqrt(Number(second)) + slope * first) /
                               limit),
                        Number(first / end));
      }

      template <typename Number>
      PointResponse<Number>
      respond(const SymmetricTensor3<Number> &strain,
              Number                         *history,
              const PointSituation<Number> &) const
      {
        const SymmetricTensor3<Number> trial =
          stress(strain - tensor_of(history));
        const auto [first, second] = invariants(trial);
        const Number shear         = std::sqrt(Number(second));
        const double G = shear_modulus(), nine_K = 9. * bulk_modulus();

        // to the cone, and from beyond the cut-off to its edge or its plane
        const Number multiplier =
          std::max(Number(shear + slope * first - limit), Number(0.)) /
          (G + nine_K * slope * flow_slope);
        const Number on_cone   = first - nine_K * flow_slope * multiplier;
        const Number new_first = std::min(on_cone, Number(end));
        const Number new_shear =
          compare_and_apply_mask<SIMDComparison::greater_than>(
            on_cone,
            Number(end),
            std::min(shear, Number(limit - slope * end)),
            Number(shear - G * multiplier));

        const Number             ratio  = new_shear / (shear + 1e-290);
        SymmetricTensor3<Number> excess = (1. - ratio) * trial;
        for (unsigned int d = 0; d < 3; ++d)
          excess[d][d] += (ratio * first - new_first) / 3.;
        return flow(strain, trial, excess, history);
      }
    };

    const Registry<Material>::Add<MaterialOf<DruckerPrager>>
      registered_drucker_prager(
        "drucker-prager",
        "Rock that yields on a cone without hardening, with tension cut-off.");
  } // namespace
} // namespace Voussoir
