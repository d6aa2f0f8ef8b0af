#include <voussoir/materials/lubliner_surface.h>

namespace Voussoir
{
  using namespace dealii;

  void
  LublinerSurface::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Biaxial ratio",
                      biaxial_ratio,
                      "Strength under equal compression in two directions "
                      "over the uniaxial one.",
                      Patterns::Double(1.01, 1.5));
  }


  void
  LublinerSurface::check()
  {
    alpha = (biaxial_ratio - 1.) / (2. * biaxial_ratio - 1.);
  }
} // namespace Voussoir
