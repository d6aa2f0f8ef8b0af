// Rock that cracks in tension and loses its cohesion in shear.

#include <voussoir/materials/isotropic_elasticity.h>
#include <voussoir/materials/material_of.h>
#include <voussoir/materials/softening_curve.h>
#include <voussoir/materials/tension_split.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Two scalar damages on the effective stress s = C : e, split into tension
     * and compression (see split_tension),
     *   sigma = (1 - d+) s+ + (1 - d-) s- .
     * The largest principal stress drives d+. The Mohr-Coulomb stress of s-,
     *   t = s1 (1 + sin phi) / (1 - sin phi) - s3   (s1 >= s3) ,
     * drives d-; its limit is the uniaxial compressive strength fc = 2 c cos
     * phi / (1 - sin phi). As t grows in proportion with s-, the stress of the
     * damaged rock has t = (1 - d-) t(s-), the softened fc: cohesion is lost,
     * while the friction of confined rock stays.
     */
    struct RockDamage : IsotropicElasticity, TensileCrack
    {
      // largest equivalent strains in tension and shear
      static constexpr unsigned int n_history = 2;

      double cohesion          = 1.5e6;
      double friction_angle    = 45.;
      double shear_energy      = 10e3;
      double residual_cohesion = 0.1;

      SofteningCurve tension, shear;
      double         friction = 0.; // (1 + sin phi) / (1 - sin phi)

      RockDamage()
      {
        young_modulus    = 15e9;
        poisson_ratio    = 0.25;
        tensile_strength = 1e6;
        fracture_energy  = 100.;
      }

      void
      declare_parameters(ParameterHandler &prm)
      {
        IsotropicElasticity::declare_parameters(prm);
        TensileCrack::declare_parameters(prm);
        prm.add_parameter("Cohesion",
                          cohesion,
                          "Shear strength c without normal stress [Pa].",
                          Patterns::Double(1.));
        prm.add_parameter("Friction angle",
                          friction_angle,
                          "Angle phi of internal friction [degrees].",
                          Patterns::Double(0., 70.));
        prm.add_parameter(
          "Shear energy",
          shear_energy,
          "Energy that the loss of cohesion takes per area of a "
          "shear band, in uniaxial compression [N/m].",
          Patterns::Double(1e-3));
        prm.add_parameter("Residual cohesion",
                          residual_cohesion,
                          "Share of the cohesion that stays.",
                          Patterns::Double(0., 0.95));
      }

      void
      check(const std::string &)
      {
        const double sine = std::sin(friction_angle * numbers::PI / 180.);
        friction          = (1. + sine) / (1. - sine);
        tension = SofteningCurve(SofteningCurve::exponential(tensile_strength,
                                                             fracture_energy),
                                 young_modulus,
                                 0.,
                                 lateral_relief(*this));
        // 2 c sqrt(friction) = 2 c cos phi / (1 - sin phi)
        const double strength = 2. * cohesion * std::sqrt(friction);
        auto         nodes =
          SofteningCurve::exponential((1. - residual_cohesion) * strength,
                                      shear_energy);
        for (auto &node : nodes)
          node.stress += residual_cohesion * strength;
        shear = SofteningCurve(nodes, young_modulus, 0.);
      }

      template <typename Number>
      Number
      load_level(const SymmetricTensor3<Number> &stress,
                 const Number                   &element_length) const
      {
        // principal values lie within mean -+ 2 sqrt(J2 / 3)
        const auto [first, second] = invariants(stress);
        const Number mean          = (1. / 3.) * first,
                     radius        = std::sqrt(Number((4. / 3.) * second)),
                     largest = mean + radius, smallest = mean - radius;
        return std::max(
          tension.load_level(largest, element_length),
          shear.load_level(Number(friction * std::min(largest, Number(0.)) -
                                  smallest),
                           element_length));
      }

      template <typename Number>
      PointResponse<Number>
      respond(const SymmetricTensor3<Number> &strain,
              Number                         *history,
              const PointSituation<Number>   &situation) const
      {
        const auto split = split_tension(stress(strain), *this);
        // the compressed part is ordered as the whole is
        const Number drive[2] = {split.principal.values[0],
                                 friction * split.compression[0] -
                                   split.compression[2]};

        PointResponse<Number> response;
        response.elastic_strain = strain;
        response.dissipation    = 0.;
        response.damping_share  = 1.;
        for (const unsigned int sign : {0, 1})
          {
            Number intact, lost;
            for (unsigned int lane = 0; lane < n_lanes<Number>(); ++lane)
              {
                const auto progress =
                  (sign == 0 ? tension : shear)
                    .go_on(lane_of(drive[sign], lane),
                           lane_of(history[sign], lane),
                           lane_of(situation.element_length, lane));
                lane_of(intact, lane) = progress.intact;
                lane_of(lost, lane)   = progress.dissipation;
              }
            const SymmetricTensor3<Number> effective = split.principal.compose(
              sign == 0 ? split.tension : split.compression);
            response.stress += intact * effective;
            response.damping_share *= intact;
            response.dissipation += 0.5 * lost * (effective * strain);
          }
        return response;
      }

      static std::vector<std::string>
      output_names()
      {
        return {"tension damage", "shear damage"};
      }

      std::vector<double>
      outputs(const double *history, const double element_length) const
      {
        std::vector<double> result;
        for (const unsigned int sign : {0, 1})
          result.push_back(history[sign] == 0. ?
                             0. :
                             (sign == 0 ? tension : shear)
                               .at(history[sign], element_length)
                               .damage(young_modulus));
        return result;
      }

      std::string
      remark(const double element_length) const
      {
        return tension.remark(element_length);
      }
    };

    const Registry<Material>::Add<MaterialOf<RockDamage>> registered(
      "rock damage",
      "Rock that cracks in tension and loses its cohesion, not its friction, in "
      "shear.");
  } // namespace
} // namespace Voussoir
