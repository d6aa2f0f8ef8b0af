#include <voussoir/base/error.h>
#include <voussoir/materials/point_test.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Strain of one component, up to which the others have no stress. */
    PointTest::Controls
    uniaxial(const double strain)
    {
      PointTest::Controls controls;
      controls[0] = {true, strain};
      return controls;
    }


    PointTest::Controls
    equibiaxial(const double strain)
    {
      PointTest::Controls controls = uniaxial(strain);
      controls[1]                  = {true, strain};
      return controls;
    }


    void
    go_to(PointTest                                              &test,
          const std::function<PointTest::Controls(const double)> &controls,
          const double                                            target,
          const unsigned int                                      steps)
    {
      const double start = test.strain[0][0];
      for (unsigned int i = 1; i <= steps; ++i)
        test.advance(controls(start + (target - start) * i / steps));
    }


    /** The largest -sigma_xx on the way [Pa]. */
    double
    strength(const Material                                         &material,
             const std::function<PointTest::Controls(const double)> &controls,
             const double                                            strain)
    {
      PointTest          test(material, 1., 1e-3);
      double             largest = 0.;
      const unsigned int steps   = 4000;
      for (unsigned int i = 1; i <= steps; ++i)
        {
          test.advance(controls(strain * i / steps));
          largest = std::max(largest, std::abs(test.stress[0][0]));
        }
      return largest;
    }


    /**
     * One point of concrete: energy of a crack for several sizes of cells,
     * closing and opening again, strength under biaxial pressure.
     */
    class MaterialPoint : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tensile strength", strength_in_tension, "[Pa]");
        prm.add_parameter("Fracture energy", fracture_energy, "[N/m]");
        prm.add_parameter("Crushing strength",
                          strength_in_compression,
                          "[Pa]; 0: not looked at");
        prm.add_parameter(
          "Openings",
          openings,
          "Points \"opening [m]: stress [Pa]\" of the softening "
          "curve.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        const auto      parameters = make_case(file);
        const Material &material   = *parameters->material_list().at(0);
        const double    modulus    = material.elastic_constants().young_modulus;
        const double    limit      = strength_in_tension / modulus;

        for (const double length : {0.25, 0.5, 1., 2.})
          {
            PointTest    test(material, length, 1e-3);
            const double end =
              15. * fracture_energy / (strength_in_tension * length);
            go_to(test, uniaxial, 0.999 * limit, 10);
            verdicts.near("stress at the tensile strength",
                          1e-6 * test.stress[0][0],
                          0.999e-6 * strength_in_tension,
                          1e-3,
                          "MPa");
            go_to(test, uniaxial, 20. * limit, 2000);
            go_to(test, uniaxial, end, 2000);
            std::ostringstream cell;
            cell << " in a cell of " << length << " m";
            verdicts.near("work to open a crack" + cell.str(),
                          test.work * length,
                          fracture_energy,
                          0.01,
                          "N/m");
            verdicts.near("energy lost" + cell.str(),
                          test.dissipated * length,
                          fracture_energy,
                          0.01,
                          "N/m");
          }

        // open, close, press, open again
        PointTest test(material, 1., 1e-3);
        go_to(test, uniaxial, 4. * limit, 400);
        const double opened = test.stress[0][0], damage = test.outputs()[0];
        verdicts.above("damage of the open crack", damage, 0.5);
        go_to(test, uniaxial, 0., 10);
        const double at_rest = test.stress[0][0];
        go_to(test, uniaxial, -limit, 10);
        verdicts.near("modulus of the closed crack",
                      1e-9 * (at_rest - test.stress[0][0]) / limit,
                      1e-9 * modulus,
                      1e-6,
                      "GPa");
        go_to(test, uniaxial, 0., 10);
        go_to(test, uniaxial, 4. * limit, 400);
        verdicts.near("stress when it opens as far again",
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
            // on the way from peak to nothing, at strains sigma/E + w/l
            PointTest opening(material, 0.5, 1e-3);
            for (const std::string &item : split_list(openings))
              {
                const auto   colon = item.find(':');
                const double w =
                  Utilities::string_to_double(item.substr(0, colon));
                const double stress =
                  Utilities::string_to_double(item.substr(colon + 1));
                go_to(opening, uniaxial, stress / modulus + w / 0.5, 50);
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
            const double one = strength(material, uniaxial, -0.01);
            verdicts.near("strength in compression",
                          1e-6 * one,
                          1e-6 * strength_in_compression,
                          0.01,
                          "MPa");
            verdicts.near("strength under biaxial over uniaxial compression",
                          strength(material, equibiaxial, -0.01) / one,
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

    const Registry<Check>::Add<MaterialPoint>
      registered("material point", "Concrete at one point.");
  } // namespace
} // namespace Voussoir
