#include <voussoir/base/usual_range.h>
#include <voussoir/materials/isotropic_elasticity.h>
#include <voussoir/materials/material_of.h>

namespace Voussoir
{
  using namespace dealii;

  void
  IsotropicElasticity::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Young's modulus",
                      young_modulus,
                      "Dynamic modulus of elasticity [Pa]." +
                        usually(Usual::modulus),
                      Patterns::Double(1.));
    prm.add_parameter("Poisson's ratio",
                      poisson_ratio,
                      "Ratio of lateral to axial strain.",
                      Patterns::Double(0., 0.495));
  }


  namespace
  {
    /** Hooke's law, with a strength that does not limit its stress. */
    struct LinearElastic : IsotropicElasticity
    {
      double tensile_strength = 0.; // [Pa]

      void
      declare_parameters(ParameterHandler &prm)
      {
        IsotropicElasticity::declare_parameters(prm);
        prm.add_parameter("Tensile strength",
                          tensile_strength,
                          "Static tensile strength, which the observer "
                          "over-stress compares with the stress [Pa]; the law "
                          "itself has no limit. 0: not given." +
                            usually(Usual::tensile_strength_or_none),
                          Patterns::Double(0.));
      }

      TensileFailure
      tensile_failure() const
      {
        return {tensile_strength, 0.};
      }
    };

    const Registry<Material>::Add<MaterialOf<LinearElastic>>
      registered_linear_elastic("linear elastic", "Isotropic Hooke's law.");
  } // namespace
} // namespace Voussoir
