#include <voussoir/mesh_sources/lifts.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  void
  Lifts::declare(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Lift height",
      height,
      "Height of the lifts in which the concrete is placed [m]; the rows of "
      "faces nearest to their tops are the face sets \"lift 1\", \"lift 2\" "
      "and so on, from below, for interfaces along lift joints. 0: no lifts.",
      Patterns::Double(0.));
  }


  void
  Lifts::lay(const std::vector<double> &elevations)
  {
    joints.clear();
    if (height > 0.)
      // with lifts lower than a row a joint between any two rows
      for (unsigned int row = 1; row + 1 < elevations.size(); ++row)
        {
          const double above =
            elevations.front() +
            height *
              std::max(1.,
                       std::round((elevations[row] - elevations[0]) / height));
          const auto distance = [&](const unsigned int other) {
            return std::abs(elevations[other] - above);
          };
          if (distance(row) < distance(row - 1) &&
              distance(row) <= distance(row + 1))
            joints[row] = elevations[row];
        }
  }


  std::string
  Lifts::joint_below(const unsigned int row) const
  {
    const auto joint = joints.find(row);
    return joint == joints.end() ?
             std::string() :
             "lift " + std::to_string(1 + std::distance(joints.begin(), joint));
  }


  std::string
  Lifts::describe() const
  {
    if (joints.empty())
      return {};
    std::ostringstream text;
    text << std::setprecision(4) << "Lift joints: " << joints.size()
         << ", from an elevation of " << joints.begin()->second << " to "
         << joints.rbegin()->second << " m";
    return text.str();
  }
} // namespace Voussoir
