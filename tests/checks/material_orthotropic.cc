#include "point_path.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Six tests under one stress each give the constants along x, y, z. */
    class MaterialOrthotropic : public MaterialCheck
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Young's moduli", young, "Along x, y, z [Pa].");
        prm.add_parameter("Shear moduli", shear, "xy, xz, yz [Pa].");
        prm.add_parameter("Poisson's ratios", poisson, "xy, xz, yz.");
      }

      void
      evaluate(const Material &material, Verdicts &verdicts) const override
      {
        const auto  &names  = PointTest::component_names();
        const double stress = 1e6;
        for (unsigned int i = 0; i < 6; ++i)
          {
            PointTest           test(material, 1., 1e-3);
            PointTest::Controls controls;
            controls[i] = {false, stress};
            test.advance(controls);
            if (i < 3)
              verdicts.near("modulus of " + names[i],
                            1e-9 * stress / test.strain[i][i],
                            1e-9 * young[i],
                            1e-9,
                            "GPa");
            else
              verdicts.near("modulus of " + names[i],
                            1e-9 * stress /
                              (2. * test.strain.access_raw_entry(i)),
                            1e-9 * shear[i - 3],
                            1e-9,
                            "GPa");
            for (unsigned int j = i + 1; j < 3; ++j)
              verdicts.near("Poisson's ratio of " + names[i] + " to " +
                              names[j],
                            -test.strain[j][j] / test.strain[i][i],
                            poisson[i + j - 1],
                            1e-9);
          }
      }

    private:
      Tensor<1, 3> young, shear, poisson;
    };

    // Reference: closed form
    const Registry<Check>::Add<MaterialOrthotropic>
      registered("orthotropic constants", "Elastic rock with directions.");
  } // namespace
} // namespace Voussoir
