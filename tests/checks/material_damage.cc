#include "point_path.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** The largest stress up to a strain along z [Pa]. */
    double
    peak(const Material    &material,
         const double       confinement,
         const double       strain,
         const unsigned int steps)
    {
      const PointTest::Control side{false, -confinement};
      PointTest                test(material, 1., 1e-3);
      advance(test, {{side, side, side}}, 5);
      double largest = 0.;
      advance(test, {{side, side, {true, strain}}}, steps, [&] {
        keep_largest(largest, -test.stress[2][2]);
      });
      return largest;
    }


    /** Work done on a crack as its plastic opening grows, against 200 N/m.
     */
    void
    check_plastic_work(const Material &material,
                       const double    tolerance,
                       Verdicts       &verdicts)
    {
      for_each_cell_size(
        material,
        [&](PointTest &pulled, const double size, const auto &in_cell) {
          double work = 0., stress = 0., opening = 0.;
          advance(pulled, {{{true, 1.5e-3 / size}, {}, {}}}, 4000, [&] {
            const double now = 1e-3 * pulled.outputs()[2];
            work += 0.5 * (stress + pulled.stress[0][0]) * (now - opening);
            stress  = pulled.stress[0][0];
            opening = now;
          });
          verdicts.near(
            "plastic work of a crack" + in_cell, work, 200., tolerance, "N/m");
        });
    }


    /** The law of Lee and Fenves with the constants of the Koyna study. */
    class MaterialLeeFenves : public MaterialCheck
    {
    public:
      void
      evaluate(const Material &material, Verdicts &verdicts) const override
      {
        const double modulus = material.elastic_constants().young_modulus;

        // tension as published: opening [m], stress [Pa], damage
        const double table[][3] = {{66.185e-6, 1.94393e6, .381217},
                                   {122.86e-6, 1.30305e6, .617107},
                                   {173.427e-6, .873463e6, .763072},
                                   {220.19e-6, .5855e6, .853393},
                                   {264.718e-6, .392472e6, .909282},
                                   {308.088e-6, .263082e6, .943865},
                                   {351.05e-6, .176349e6, .965265},
                                   {394.138e-6, .11821e6, .978506},
                                   {437.744e-6, .0792388e6, .9867},
                                   {482.165e-6, .0531154e6, .99177}};
        PointTest    test(material, 1., 1e-3);
        for (const auto &[cracking, stress, damage] : table)
          {
            // its openings are those of sigma / E + u_ck
            advance(test, {{{true, stress / modulus + cracking}, {}, {}}}, 50);
            std::ostringstream name;
            name << " at a cracking displacement of " << 1e3 * cracking
                 << " mm";
            verdicts.near("stress" + name.str(),
                          1e-6 * test.stress[0][0],
                          1e-6 * stress,
                          1e-3,
                          "MPa");
            verdicts.near("damage" + name.str(),
                          test.outputs()[0],
                          damage,
                          1e-3);
          }

        check_plastic_work(material, 0.01, verdicts);

        verdicts.near("strength in compression",
                      1e-6 * peak(material, 0., -6e-3, 1000),
                      24.1,
                      1e-3,
                      "MPa");
        verdicts.near("yield stress in compression",
                      1e-6 * yield_stress(material, false),
                      13.,
                      2e-3,
                      "MPa");
        verdicts.near("yield stress in biaxial compression",
                      1e-6 * yield_stress(material, true),
                      1.16 * 13.,
                      2e-3,
                      "MPa");

        // the apex: (3 alpha + beta) p = (1 - alpha) fc0
        PointTest pulled(material, 1., 1e-3);
        double    pull = 0.;
        advance(pulled,
                {{{true, 3e-4}, {true, 3e-4}, {true, 3e-4}}},
                3000,
                [&] {
                  if (pulled.outputs()[0] == 0.)
                    pull = pulled.stress[0][0];
                });
        const double alpha = 0.16 / 1.32;
        verdicts.near("yield stress in tension from all sides",
                      1e-6 * pull,
                      (1. - alpha) * 13. /
                        (2. * alpha - 1. + (1. - alpha) * 13. / 2.9),
                      2e-3,
                      "MPa");
        // and beyond: p = 3 K (e - k_t) with the strengths of k_t
        const double plastic = 1e-3 * pulled.outputs()[2],
                     tension = 2.9e6 * std::exp((1.2 - 1.) * 14500. * plastic),
                     beta    = (1. - alpha) * 13e6 / tension - 1. - alpha;
        verdicts.near("effective stress when it has softened",
                      1e-6 * modulus / (1. - 2. * 0.2) * (3e-4 - plastic),
                      1e-6 * (1. - alpha) * 13e6 / (3. * alpha + beta),
                      1e-6,
                      "MPa");
      }

    private:
      double
      yield_stress(const Material &material, const bool biaxial) const
      {
        PointTest                test(material, 1., 1e-3);
        const PointTest::Control pressed{true, -1e-3};
        double                   stress = 0.;
        advance(test,
                {{pressed, biaxial ? pressed : PointTest::Control(), {}}},
                2000,
                [&] {
                  if (test.outputs()[1] == 0.)
                    stress = -test.stress[0][0];
                });
        return stress;
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<MaterialLeeFenves>
      lee_fenves("lee-fenves", "The reference law of concrete at one point.");


    /** A crack of this law that closes, is compressed and opens again. */
    class MaterialLeeFenvesClosing : public MaterialCheck
    {
    public:
      void
      evaluate(const Material &material, Verdicts &verdicts) const override
      {
        const double modulus = material.elastic_constants().young_modulus;

        // an open crack is relieved of its lateral stress too, so that the
        // effective stress is no longer uniaxial
        check_plastic_work(material, 0.05, verdicts);

        // a crack that closes, is compressed and opens again
        PointTest cycle(material, 1., 1e-3);
        advance(cycle, {{{true, 4e-4}, {}, {}}}, 2000);
        const double opened = cycle.stress[0][0];
        advance(cycle, {{{true, 1.5e-4}, {}, {}}}, 2000);
        const double closed = cycle.stress[0][0];
        advance(cycle, {{{true, 1e-4}, {}, {}}}, 50);
        verdicts.near("modulus of the closed crack",
                      1e-9 * (closed - cycle.stress[0][0]) / 5e-5,
                      1e-9 * modulus,
                      1e-6,
                      "GPa");
        advance(cycle, {{{true, 4e-4}, {}, {}}}, 2000);
        verdicts.near("stress on reopening to the same strain",
                      1e-6 * cycle.stress[0][0],
                      1e-6 * opened,
                      1e-6,
                      "MPa");
        verdicts.near("energy lost and stored over the work",
                      (cycle.dissipated + cycle.stored) / cycle.work,
                      1.,
                      1e-3);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<MaterialLeeFenvesClosing>
      lee_fenves_closing("lee-fenves closing",
                         "Cracks of the reference law that close.");


    /** Strength of rock before and after it has lost its cohesion. */
    class MaterialRockShear : public MaterialCheck
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Cohesion", cohesion, "[Pa]");
        prm.add_parameter("Friction angle", friction_angle, "[degrees]");
        prm.add_parameter("Residual cohesion", residual, "Share.");
        prm.add_parameter("Shear energy", energy, "[N/m]");
      }

      void
      evaluate(const Material &material, Verdicts &verdicts) const override
      {
        const double sine   = std::sin(friction_angle * numbers::PI / 180.),
                     factor = (1. + sine) / (1. - sine),
                     one    = 2. * cohesion * std::sqrt(factor);
        for (const double confinement : {0., 0.5e6, 2e6})
          {
            std::ostringstream name;
            name << " under a confinement of " << 1e-6 * confinement << " MPa";
            verdicts.near("strength" + name.str(),
                          1e-6 * peak(material, confinement, -4e-3, 4000),
                          1e-6 * (one + factor * confinement),
                          2e-3,
                          "MPa");
            if (confinement != 0.5e6)
              continue; // confinement prolongs the softening
            const PointTest::Control side{false, -confinement};
            PointTest                test(material, 1., 1e-3);
            advance(test, {{side, side, side}}, 5);
            advance(test, {{side, side, {true, -0.1}}}, 4000);
            verdicts.near("residual strength" + name.str(),
                          -1e-6 * test.stress[2][2],
                          1e-6 * (residual * one + factor * confinement),
                          1e-3,
                          "MPa");
          }
        for_each_cell_size(
          material,
          [&](PointTest &test, const double size, const auto &in_cell) {
            const double end = 15. * energy / (one * size);
            advance(test, {{{true, -end}, {}, {}}}, 8000);
            const double stays = residual * one;
            verdicts.near("energy beyond the residual strength" + in_cell,
                          size * (test.work - stays * end +
                                  0.5 * stays * stays /
                                    material.elastic_constants().young_modulus),
                          energy,
                          0.01,
                          "N/m");
          });
      }

    private:
      double cohesion = 1.5e6, friction_angle = 45., residual = 0.1,
             energy = 10e3;
    };

    // Reference: closed form
    const Registry<Check>::Add<MaterialRockShear>
      rock_shear("rock shear damage", "Rock that loses cohesion, at a point.");


    /** The law of Mazars: energy of a crack and strength in compression. */
    class MaterialMazars : public MaterialCheck
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tensile strength", strength, "[Pa]");
        prm.add_parameter("Fracture energy", energy, "[N/m]");
        prm.add_parameter("Compression A", a, "");
        prm.add_parameter("Compression B", b, "");
      }

      void
      evaluate(const Material &material, Verdicts &verdicts) const override
      {
        const auto constants = material.elastic_constants();
        for_each_cell_size(
          material,
          [&](PointTest &test, const double size, const auto &in_cell) {
            const double end = 15. * energy / (strength * size);
            advance(test, {{{true, end}, {}, {}}}, 8000);
            verdicts.near("work to open a crack" + in_cell,
                          test.work * size,
                          energy,
                          0.01,
                          "N/m");
          });
        // with k = sqrt(2) nu e, the stress is largest at k = 1 / B
        const double threshold = strength / constants.young_modulus;
        verdicts.near("strength in compression",
                      1e-6 * peak(material, 0., -6e-3, 4000),
                      1e-6 * constants.young_modulus /
                        (std::sqrt(2.) * constants.poisson_ratio) *
                        ((1. - a) * threshold +
                         a / b * std::exp(b * threshold - 1.)),
                      1e-4,
                      "MPa");
      }

    private:
      double strength = 2.5e6, energy = 250., a = 1.1, b = 1500.;
    };

    // Reference: closed form
    const Registry<Check>::Add<MaterialMazars>
      mazars("mazars", "Mazars' law at one point.");
  } // namespace
} // namespace Voussoir
