#include <voussoir/materials/material.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** sigma = lambda tr(epsilon) I + 2 G epsilon */
    struct LinearElastic
    {
      double young_modulus = 24e9;
      double poisson_ratio = 0.2;

      void
      declare_parameters(ParameterHandler &prm)
      {
        prm.add_parameter("Young's modulus",
                          young_modulus,
                          "Dynamic modulus of elasticity [Pa].",
                          Patterns::Double(1.));
        prm.add_parameter("Poisson's ratio",
                          poisson_ratio,
                          "Ratio of lateral to axial strain.",
                          Patterns::Double(0., 0.495));
      }

      void
      check(const std::string &) const
      {}

      template <typename Number>
      SymmetricTensor3<Number>
      stress(const SymmetricTensor3<Number> &strain) const
      {
        const double two_shear = young_modulus / (1. + poisson_ratio);
        const double lambda =
          two_shear * poisson_ratio / (1. - 2. * poisson_ratio);
        SymmetricTensor3<Number> result   = two_shear * strain;
        const Number             pressure = lambda * trace(strain);
        for (unsigned int d = 0; d < 3; ++d)
          result[d][d] += pressure;
        return result;
      }
    };

    const Registry<Material>::Add<MaterialOf<LinearElastic>>
      registered("linear elastic", "Isotropic Hooke's law.");
  } // namespace
} // namespace Voussoir
