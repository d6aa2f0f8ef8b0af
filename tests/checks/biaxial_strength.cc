#include <voussoir/base/error.h>

#include "point_path.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Strength in plane stress beside that of Kupfer and Gerstle (1973), who
     * fitted tests on plates: under compression in both directions at the ratio
     * r, the larger one reaches
     *   fc (1 + 3.65 r) / (1 + r)^2 ,
     * and two tensions reach ft.
     */
    class BiaxialStrength : public MaterialCheck
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tensile strength", tensile, "[Pa]");
        prm.add_parameter("Compressive strength", compressive, "[Pa]");
        prm.add_parameter("Allowed in compression", in_compression);
        prm.add_parameter("Allowed in tension", in_tension);
        prm.add_parameter("Beside compression",
                          beside_compression,
                          "Compressions over fc beside which the strength in "
                          "tension must be that of tension alone.");
      }

    private:
      void
      evaluate(const Material &material, Verdicts &verdicts) const override
      {
        for (const double ratio : {0., 0.25, 0.5, 0.75, 1.})
          verdicts.near("compression at the ratio " + short_text(ratio) +
                          ", over fc",
                        largest(material, -6e-3, ratio) / compressive,
                        (1. + 3.65 * ratio) / std::pow(1. + ratio, 2),
                        in_compression);
        for (const double ratio : {0., 0.5, 1.})
          verdicts.near("tension at the ratio " + short_text(ratio) +
                          ", over ft",
                        largest(material, 3e-4, ratio) / tensile,
                        1.,
                        in_tension);
        for (const double share :
             Utilities::string_to_double(split_list(beside_compression)))
          verdicts.near("tension beside a compression of " + short_text(share) +
                          " fc, over ft",
                        beside(material, share) / tensile,
                        1.,
                        in_tension);
      }

      static std::string
      short_text(const double number)
      {
        std::ostringstream text;
        text << number;
        return text.str();
      }

      /** Largest stress along x on a path to a strain, with the stress along y
       *  in proportion to it [Pa]. */
      static double
      largest(const Material &material, const double strain, const double ratio)
      {
        PointTest test(material, 0.1, 1e-3);
        return largest(test, strain, [&] { return ratio * test.stress[0][0]; });
      }

      /** Largest tension along x beside a constant compression along y, over fc
       *  [Pa]. */
      double
      beside(const Material &material, const double share) const
      {
        const double stress = -share * compressive;
        PointTest    test(material, 0.1, 1e-3);
        advance(test, {{{}, {false, stress}, {}}}, 1000);
        return largest(test, test.strain[0][0] + 3e-4, [&] { return stress; });
      }

      /** Largest stress along x on the way to a strain; the path ends where no
       *  strain gives the stress along y, which the strength then limits. */
      static double
      largest(PointTest                     &test,
              const double                   strain,
              const std::function<double()> &stress_along_y)
      {
        const double       start  = test.strain[0][0];
        const unsigned int steps  = 4000;
        double             result = 0.;
        try
          {
            for (unsigned int i = 1; i <= steps; ++i)
              {
                PointTest::Controls controls;
                controls[0] = {true, start + (strain - start) * i / steps};
                controls[1] = {false, stress_along_y()};
                test.advance(controls);
                keep_largest(result, std::abs(test.stress[0][0]));
              }
          }
        catch (const UserError &)
          {}
        return result;
      }

      double tensile = 2.5e6, compressive = 25e6, in_compression = 0.05,
             in_tension = 0.01;
      std::string beside_compression;
    };

    // Reference: published
    const Registry<Check>::Add<BiaxialStrength>
      registered("biaxial strength",
                 "Strength in plane stress beside published tests.");
  } // namespace
} // namespace Voussoir
