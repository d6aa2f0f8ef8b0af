#ifndef voussoir_materials_cohesion_and_friction_h
#define voussoir_materials_cohesion_and_friction_h

#include <deal.II/base/parameter_handler.h>

namespace Voussoir
{
  /** Entries of the laws with the strength of Mohr and Coulomb. */
  struct CohesionAndFriction
  {
    double cohesion       = 1.5e6; // c [Pa]
    double friction_angle = 45.;   // phi [degrees]

    void
    declare_parameters(dealii::ParameterHandler &prm);
  };
} // namespace Voussoir

#endif
