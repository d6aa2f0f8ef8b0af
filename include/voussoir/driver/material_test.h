#ifndef voussoir_driver_material_test_h
#define voussoir_driver_material_test_h

#include <voussoir/base/log.h>
#include <voussoir/materials/point_test.h>

#include <deal.II/base/parameter_handler.h>

namespace Voussoir
{
  /** The entries of the section "Material test": a path of strains and stresses
   *  for one point of a material. */
  struct MaterialTestParameters
  {
    std::string  material;
    std::string  strains = "xx: 0, 2e-4, 0, -2e-3, 0, 1e-3";
    std::string  stresses;
    unsigned int steps          = 200;
    double       segment_time   = 1.;
    double       element_length = 1.;

    void
    declare(dealii::ParameterHandler &prm);

    /** Runs the test on the material and writes its table. */
    void
    run(const Material &tested, std::ostream &csv) const;
  };
} // namespace Voussoir

#endif
