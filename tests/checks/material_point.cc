#include "point_path.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Strain of one component, no stress of the others. */
    NormalControls
    uniaxial(const double strain)
    {
      return {{{true, strain}, {}, {}}};
    }


    /** The largest -sigma_xx of the path [Pa]. */
    double
    strength(const Material &material, const NormalControls &target)
    {
      PointTest test(material, 1., 1e-3);
      double    largest = 0.;
      advance(test, target, 4000, [&] {
        keep_largest(largest, -test.stress[0][0]);
      });
      return largest;
    }


    /**
     * One point of concrete: energy of a crack for several sizes of cells,
     * closing and opening again, strength under biaxial pressure.
     */
    class MaterialPoint : public MaterialCheck
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tensile strength", strength_in_tension, "[Pa]");
        prm.add_parameter("Fracture energy", fracture_energy, "[N/m]");
        prm.add_parameter("Crushing strength",
                          strength_in_compression,
                          "[Pa]; 0: not compared");
        prm.add_parameter(
          "Openings",
          openings,
          "Points \"opening [m]: stress [Pa]\" of the softening "
          "curve.");
      }

      void
      evaluate(const Material &material, Verdicts &verdicts) const override
      {
        const double modulus = material.elastic_constants().young_modulus;
        const double limit   = strength_in_tension / modulus;

        for_each_cell_size(
          material,
          [&](PointTest &test, const double size, const auto &in_cell) {
            const double end =
              15. * fracture_energy / (strength_in_tension * size);
            advance(test, uniaxial(0.999 * limit), 10);
            verdicts.near("stress at the tensile strength",
                          1e-6 * test.stress[0][0],
                          0.999e-6 * strength_in_tension,
                          1e-3,
                          "MPa");
            advance(test, uniaxial(20. * limit), 2000);
            advance(test, uniaxial(end), 2000);
            verdicts.near("work to open a crack" + in_cell,
                          test.work * size,
                          fracture_energy,
                          0.01,
                          "N/m");
            verdicts.near("energy lost" + in_cell,
                          test.dissipated * size,
                          fracture_energy,
                          0.01,
                          "N/m");
          });

        // open, close, press, open again
        PointTest test(material, 1., 1e-3);
        advance(test, uniaxial(4. * limit), 400);
        const double opened = test.stress[0][0], damage = test.outputs()[0];
        verdicts.above("damage of the open crack", damage, 0.5);
        advance(test, uniaxial(0.), 10);
        const double at_rest = test.stress[0][0];
        advance(test, uniaxial(-limit), 10);
        verdicts.near("modulus of the closed crack",
                      1e-9 * (at_rest - test.stress[0][0]) / limit,
                      1e-9 * modulus,
                      1e-6,
                      "GPa");
        advance(test, uniaxial(0.), 10);
        advance(test, uniaxial(4. * limit), 400);
        verdicts.near("stress on reopening to the same strain",
                      1e-6 * test.stress[0][0],
                      1e-6 * opened,
                      1e-6,
                      "MPa");
        const double nu     = material.elastic_constants().poisson_ratio;
        const double relief = 2. * nu * nu / (1. - nu);
        verdicts.near("its modulus against (1 - d) E/(1 - k d)",
                      1e-9 * (opened - at_rest) / (4. * limit),
                      1e-9 * (1. - damage) * modulus / (1. - relief * damage),
                      1e-6,
                      "GPa");

        if (!openings.empty())
          {
            // between the peak and zero stress, at strains sigma/E + w/l
            PointTest opening(material, 0.5, 1e-3);
            for (const std::string &item : split_list(openings))
              {
                const auto   colon = item.find(':');
                const double w =
                  Utilities::string_to_double(item.substr(0, colon));
                const double stress =
                  Utilities::string_to_double(item.substr(colon + 1));
                advance(opening, uniaxial(stress / modulus + w / 0.5), 50);
                std::ostringstream name;
                name << "stress at an opening of " << 1e3 * w << " mm";
                verdicts.near(name.str(),
                              1e-6 * opening.stress[0][0],
                              1e-6 * stress,
                              1e-6,
                              "MPa");
              }
          }

        if (strength_in_compression > 0.)
          {
            const PointTest::Control pressed{true, -0.01};
            const double             one = strength(material, uniaxial(-0.01));
            verdicts.near("strength in compression",
                          1e-6 * one,
                          1e-6 * strength_in_compression,
                          0.01,
                          "MPa");
            verdicts.near("strength under biaxial over uniaxial compression",
                          strength(material, {{pressed, pressed, {}}}) / one,
                          1.16,
                          0.005);
          }
      }

    private:
      double      strength_in_tension     = 2.5e6;
      double      fracture_energy         = 250.;
      double      strength_in_compression = 25e6;
      std::string openings;
    };

    // Reference: closed form
    const Registry<Check>::Add<MaterialPoint>
      registered("material point", "Concrete at one point.");
  } // namespace
} // namespace Voussoir
