#include <voussoir/mesh_sources/lift_joints.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  void
  LiftJoints::declare(ParameterHandler &prm, double &height)
  {
    prm.add_parameter(
      "Lift height",
      height,
      "Height of the lifts in which the concrete is placed [m]; the rows of "
      "faces nearest to their tops are the face sets \"lift 1\", \"lift 2\" "
      "and so on, from below, for interfaces along lift joints. 0: no lifts.",
      Patterns::Double(0.));
  }


  LiftJoints::LiftJoints(const double               height,
                         const std::vector<double> &elevations)
  {
    if (height == 0.)
      return;
    // with lifts lower than a row a joint between any two rows
    for (unsigned int row = 1; row + 1 < elevations.size(); ++row)
      {
        const double n_lifts =
          std::round((elevations[row] - elevations[0]) / height);
        const double top      = elevations[0] + height * std::max(1., n_lifts);
        const auto   distance = [&](const unsigned int other) {
          return std::abs(elevations[other] - top);
        };
        if (distance(row) < distance(row - 1) &&
            distance(row) <= distance(row + 1))
          elevation[row] = elevations[row];
      }
  }


  std::string
  LiftJoints::below(const unsigned int row) const
  {
    const auto joint = elevation.find(row);
    return joint == elevation.end() ?
             std::string() :
             "lift " +
               std::to_string(1 + std::distance(elevation.begin(), joint));
  }


  void
  LiftJoints::add_remark(CoarseMesh &mesh) const
  {
    if (elevation.empty())
      return;
    std::ostringstream text;
    text << std::setprecision(4) << "Lift joints: " << elevation.size()
         << ", from an elevation of " << elevation.begin()->second << " to "
         << elevation.rbegin()->second << " m";
    mesh.remarks.push_back(text.str());
  }
} // namespace Voussoir
