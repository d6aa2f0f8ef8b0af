#ifndef voussoir_mesh_sources_grading_h
#define voussoir_mesh_sources_grading_h

#include <voussoir/base/error.h>

#include <algorithm>
#include <vector>

namespace Voussoir
{
  /**
   * Points from exactly 0 to exactly 1 that cut @p length into cells which
   * begin with @p size, grow by the ratio @p growth >= 1 and stay at @p largest
   * once they have reached it; all are stretched a little to fit.
   */
  inline std::vector<double>
  graded_points(const double length,
                const double size,
                const double growth,
                const double largest)
  {
    std::vector<double> points{0.};
    double              cell = std::min(size, largest);
    while (points.back() + 0.5 * cell < length || points.size() == 1)
      {
        if (points.size() > 1000000)
          throw UserError("In section \"Mesh\" the cells are so small, or the "
                          "rock or water so long, that a million cells would "
                          "lie in a row; change these entries.");
        points.push_back(points.back() + cell);
        cell = std::min(growth * cell, largest);
      }
    for (double &point : points)
      point /= points.back();
    return points;
  }
} // namespace Voussoir

#endif
