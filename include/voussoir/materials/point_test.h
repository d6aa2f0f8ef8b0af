#ifndef voussoir_materials_point_test_h
#define voussoir_materials_point_test_h

#include <voussoir/materials/material.h>

#include <array>

namespace Voussoir
{
  /**
   * A laboratory test on one point of a material: of each of the six components
   * either the strain or the stress is given.
   */
  class PointTest
  {
  public:
    /** Given value of a component: strain, or stress [Pa]. */
    struct Control
    {
      bool   is_strain = false;
      double value     = 0.;
    };

    /** Components in the order xx, yy, zz, xy, xz, yz. */
    using Controls = std::array<Control, 6>;

    static const std::array<std::string, 6> &
    component_names();

    /** @param element_length of the cell that the point represents [m] */
    PointTest(const Material &material,
              const double    element_length,
              const double    time_step);

    /** One step. Throws UserError if no strain gives the prescribed stresses,
     *  as beyond the strength. */
    void
    advance(const Controls &controls);

    /** The values of the material's `output_names`. */
    std::vector<double>
    outputs() const;

    SymmetricTensor3<double> strain, stress;

    /** Work done and dissipated since the start [J/m3]. */
    double work = 0., dissipated = 0.;

    /** Energy stored now [J/m3]. */
    double stored = 0.;

  private:
    const Material              &material;
    const PointSituation<double> situation;
    std::vector<double>          history;
  };
} // namespace Voussoir

#endif
