// Rock that cracks in tension and loses its cohesion in shear.

#include <voussoir/base/usual_range.h>
#include <voussoir/materials/cohesion_and_friction.h>
#include <voussoir/materials/material_of.h>
#include <voussoir/materials/split_damage.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A SplitDamage whose d+ is driven by the largest principal stress. The
     * Mohr-Coulomb stress of s-,
     *   t = s1 (1 + sin phi) / (1 - sin phi) - s3   (s1 >= s3) ,
     * drives d-; its limit is the uniaxial compressive strength fc = 2 c cos
     * phi / (1 - sin phi). As t grows in proportion with s-, the stress of the
     * damaged rock has t = (1 - d-) t(s-), the softened fc: cohesion is lost,
     * while the friction of confined rock stays.
     */
    struct RockDamage : SplitDamage, CohesionAndFriction
    {
      static constexpr unsigned int n_history = n_split_numbers;

      double shear_energy      = 10e3;
      double residual_cohesion = 0.1;

      double friction = 0.; // (1 + sin phi) / (1 - sin phi)

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
        SplitDamage::declare_parameters(prm);
        CohesionAndFriction::declare_parameters(prm);
        prm.add_parameter(
          "Shear energy",
          shear_energy,
          "Energy that the loss of cohesion takes per area of a "
          "shear band, in uniaxial compression [N/m]." +
            usually(Usual::crushing_energy),
          Patterns::Double(1e-3));
        prm.add_parameter("Residual cohesion",
                          residual_cohesion,
                          "Share of the cohesion that remains after shear "
                          "failure.",
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
        compression = SofteningCurve(nodes, young_modulus, 0.);
      }

      template <typename Number>
      Number
      yield_ratio(const SymmetricTensor3<Number> &stress,
                  const Number                   &element_length) const
      {
        const auto [smallest, largest] = principal_bounds(stress);
        return std::max(tension.yield_ratio(largest, element_length),
                        compression.yield_ratio(
                          Number(friction * std::min(largest, Number(0.)) -
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
        // the compressed part has the order of the whole stress
        const OfBoth<Number> equivalent{
          {split.principal.values[0],
           friction * split.compression[0] - split.compression[2]}};
        const OfBoth<DamageProgress<Number>> damage{
          {grow_crack(equivalent[0], history, situation),
           grow(1, equivalent[1], history + n_of_curve, situation)}};
        return response(parts(split, history, situation.crack_normal),
                        damage,
                        strain);
      }

      static std::vector<std::string>
      output_names()
      {
        return {OutputName::tension_damage,
                "shear damage",
                OutputName::largest_opening};
      }

      std::vector<double>
      outputs(const double *history, const double element_length) const
      {
        return {damage_of(history, 0),
                damage_of(history, 1),
                1e3 * largest_opening(history, element_length)};
      }
    };

    const Registry<Material>::Add<MaterialOf<RockDamage>> registered_rock_damage(
      "rock damage",
      "Rock that cracks in tension and loses its cohesion, not its friction, in "
      "shear.");
  } // namespace
} // namespace Voussoir
