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
    const Registry<Material>::Add<MaterialOf<IsotropicElasticity>>
      registered("linear elastic", "Isotropic Hooke's law.");
  } // namespace
} // namespace Voussoir
