#include <voussoir/materials/spectral.h>

#include <random>

#include "point_path.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Rock without hardening at one point: strengths in the tests of a rock
     * laboratory, corners of the yield surface, growth of volume. Stresses of
     * the tests are positive in compression.
     */
    class MaterialPlastic : public MaterialCheck
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Surface",
                          surface,
                          "",
                          Patterns::Selection(
                            "planes|compression cone|plane strain cone"));
        prm.add_parameter("Cohesion", cohesion, "[Pa]");
        prm.add_parameter("Friction angle", friction_angle, "[degrees]");
        prm.add_parameter("Dilation angle", dilation_angle, "[degrees]");
        prm.add_parameter("Tension cut-off",
                          cut_off,
                          "[Pa]; 0: beyond the apex");
        prm.add_parameter("Confinement", confinement, "[Pa]");
      }

      void
      evaluate(const Material &material, Verdicts &verdicts) const override
      {
        const double phi    = friction_angle * numbers::PI / 180.,
                     psi    = dilation_angle * numbers::PI / 180.;
        const double factor = (1. + std::sin(phi)) / (1. - std::sin(phi)),
                     one = 2. * cohesion * std::cos(phi) / (1. - std::sin(phi));
        const double apex = cohesion / std::tan(phi);

        // in compression the planes and the cone that is fitted there have the
        // same strength
        if (surface != "plane strain cone")
          {
            verdicts.near("uniaxial compression",
                          1e-6 * strength(material, 0., -1.),
                          1e-6 * one,
                          1e-6,
                          "MPa");
            verdicts.near("triaxial compression",
                          1e-6 * strength(material, confinement, -1.),
                          1e-6 * (one + factor * confinement),
                          1e-6,
                          "MPa");
            verdicts.near("growth of volume over shortening",
                          volume_change(material),
                          2. * std::sin(psi) / (1. - std::sin(psi)),
                          1e-5);
          }
        if (surface == "planes")
          verdicts.near("triaxial extension",
                        1e-6 * strength(material, confinement, 1.),
                        1e-6 * (confinement - one) / factor,
                        1e-6,
                        "MPa");
        else if (surface == "compression cone")
          {
            // (P - S) / sqrt(3) - a (S + 2 P) = k
            const double scale = std::sqrt(3.) * (3. - std::sin(phi)),
                         a     = 2. * std::sin(phi) / scale,
                         k     = 6. * cohesion * std::cos(phi) / scale;
            verdicts.near("triaxial extension",
                          1e-6 * strength(material, confinement, 1.),
                          1e-6 *
                            (confinement * (1. / std::sqrt(3.) - 2. * a) - k) /
                            (1. / std::sqrt(3.) + a),
                          1e-6,
                          "MPa");
          }
        if (surface != "compression cone")
          verdicts.near("compression in plane strain",
                        1e-6 * strength_in_plane_strain(material),
                        1e-6 * (one + factor * confinement),
                        1e-4,
                        "MPa");

        PointTest pulled(material, 1., 1e-3);
        advance(pulled, {{{true, 1e-3}, {true, 1e-3}, {true, 1e-3}}}, 20);
        verdicts.near("tension from all sides",
                      1e-6 * pulled.stress[0][0],
                      1e-6 * (cut_off > 0. ? cut_off : apex),
                      1e-9,
                      "MPa");
        if (surface == "planes" && cut_off > 0.)
          verdicts.near("uniaxial tension",
                        1e-6 * -strength(material, 0., 1.),
                        1e-6 * cut_off,
                        1e-6,
                        "MPa");

        if (surface == "planes")
          evaluate_random_returns(material, verdicts);
      }

    private:
      /** After pressure from all sides, the other two stresses are constant. */
      PointTest
      failed(const Material &material,
             const double    pressure,
             const double    strain) const
      {
        const PointTest::Control side{false, -pressure};
        PointTest                test(material, 1., 1e-3);
        advance(test, {{side, side, side}}, 5);
        advance(test, {{side, side, {true, strain}}}, 100);
        return test;
      }

      double
      strength(const Material &material,
               const double    pressure,
               const double    direction) const
      {
        return -failed(material, pressure, 0.02 * direction).stress[2][2];
      }

      double
      volume_change(const Material &material) const
      {
        PointTest    test   = failed(material, confinement, -0.02);
        const double volume = trace(test.strain), axial = test.strain[2][2];
        const PointTest::Control side{false, -confinement};
        advance(test, {{side, side, {true, -0.03}}}, 50);
        return (trace(test.strain) - volume) / (axial - test.strain[2][2]);
      }

      double
      strength_in_plane_strain(const Material &material) const
      {
        const PointTest::Control side{false, -confinement};
        PointTest                test(material, 1., 1e-3);
        advance(test, {{side, side, side}}, 5);
        advance(test, {{side, {true, test.strain[1][1]}, {true, -0.05}}}, 500);
        return -test.stress[2][2];
      }

      /** All planes, edges and corners: after a return, the stress is neither
       *  beyond nor inside the surface. */
      void
      evaluate_random_returns(const Material &material,
                              Verdicts       &verdicts) const
      {
        const double sine  = std::sin(friction_angle * numbers::PI / 180.),
                     limit = 2. * cohesion *
                             std::cos(friction_angle * numbers::PI / 180.);
        const double tension = cut_off > 0. ?
                                 cut_off :
                                 cohesion * std::sqrt(1. / (sine * sine) - 1.);
        const auto   excess  = [&](const SymmetricTensor<2, 3> &stress) {
          auto s = spectrum(stress).values;
          std::sort(s.begin(), s.end());
          return std::max((s[2] - s[0] + (s[2] + s[0]) * sine - limit) / limit,
                          s[2] / tension - 1.);
        };
        std::mt19937                     random(3);
        std::normal_distribution<double> normal;
        double                           worst = 0.;
        for (unsigned int i = 0; i < 20000; ++i)
          {
            SymmetricTensor<2, 3> strain;
            for (unsigned int k = 0; k < 6; ++k)
              strain.access_raw_entry(k) =
                1e-3 * normal(random) + (k < 3 ? 5e-4 : 0.);
            std::vector<double> history(material.n_history());
            const double        trial = excess(material.stress(strain));
            const double        now   = excess(
              material.respond(strain, history.data(), {1., 1e-3}).stress);
            keep_largest(worst, trial > 0. ? std::abs(now) : now);
          }
        verdicts.below("distance to the yield surface after 20000 returns",
                       worst,
                       1e-9);
      }

      std::string surface  = "planes";
      double      cohesion = 1.5e6, friction_angle = 45., dilation_angle = 10.,
             cut_off = 0., confinement = 20e6;
    };

    // Reference: closed form
    const Registry<Check>::Add<MaterialPlastic>
      registered("rock plasticity", "Rock that yields, at one point.");
  } // namespace
} // namespace Voussoir
