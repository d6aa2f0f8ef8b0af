#ifndef voussoir_mesh_grading_h
#define voussoir_mesh_grading_h

#include <algorithm>
#include <cmath>
#include <vector>

namespace Voussoir
{
  /**
   * @p n + 1 points from exactly 0 to exactly 1 whose distances grow by the
   * ratio @p growth.
   */
  inline std::vector<double>
  graded_points(const unsigned int n, const double growth)
  {
    std::vector<double> points(n + 1, 0.);
    for (unsigned int i = 0; i < n; ++i)
      points[i + 1] = points[i] + std::pow(growth, i);
    for (double &point : points)
      point /= points.back();
    return points;
  }


  /**
   * How many cells fill @p length if they begin with @p size and grow by the
   * ratio @p growth >= 1; rounded, at least 1.
   */
  inline unsigned int
  n_graded_cells(const double length, const double size, const double growth)
  {
    const double n =
      growth > 1. + 1e-6 ?
        std::log1p(length * (growth - 1.) / size) / std::log(growth) :
        length / size;
    return std::max(1., std::round(n));
  }
} // namespace Voussoir

#endif
