#ifndef voussoir_tests_cylinder_dam_h
#define voussoir_tests_cylinder_dam_h

#include <cmath>

namespace Voussoir
{
  /**
   * A dam in closed form: a cylinder of constant thickness between straight
   * banks, R = 120, T = 10, H = 100, half widths 100 and 80 above, 20 below
   * [m].
   */
  namespace CylinderDam
  {
    constexpr double radius = 120., thickness = 10., height = 100.,
                     base_half_width    = 20.;
    constexpr double crest_half_width[] = {100., 80.};

    /** y of the axis, where the upstream face begins at zero [m]. */
    constexpr double centre = -(radius + 0.5 * thickness);

    /** [m3] */
    inline double
    volume()
    {
      const auto flank = [](const double w) {
        return w * std::asin(w / radius) + std::sqrt(radius * radius - w * w);
      };
      double sum = 0.;
      for (const double w : crest_half_width)
        sum += thickness * radius * height / (w - base_half_width) *
               (flank(w) - flank(base_half_width));
      return sum;
    }
  } // namespace CylinderDam
} // namespace Voussoir

#endif
