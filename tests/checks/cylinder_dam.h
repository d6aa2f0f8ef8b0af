#ifndef voussoir_tests_cylinder_dam_h
#define voussoir_tests_cylinder_dam_h

#include <cmath>
#include <string>
#include <vector>

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

    /** Its entries in section "Mesh/arch dam". */
    inline std::vector<std::string>
    entries()
    {
      std::vector<std::string> result;
      for (const char *entry : {"Arch=circle",
                                "Crest radius=120",
                                "Base radius=120",
                                "Crest half width=100, 80",
                                "Base half width=20, 20",
                                "Canyon exponent=1",
                                "Crown face=0, 0, 0",
                                "Crown thickness=10, 0, 0, 0",
                                "Abutment thickness=1"})
        result.push_back(std::string("Mesh/arch dam/Custom shape/") + entry);
      return result;
    }

    /** Volume below an elevation [m3]. */
    inline double
    volume(const double elevation = height)
    {
      const auto flank = [](const double w) {
        return w * std::asin(w / radius) + std::sqrt(radius * radius - w * w);
      };
      double sum = 0.;
      for (const double w : crest_half_width)
        sum +=
          thickness * radius * height / (w - base_half_width) *
          (flank(base_half_width + (w - base_half_width) * elevation / height) -
           flank(base_half_width));
      return sum;
    }
  } // namespace CylinderDam
} // namespace Voussoir

#endif
