#include <voussoir/analysis/measured_shapes.h>
#include <voussoir/analysis/modes.h>
#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/base/text.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string place_of_points =
      "\"Measured points\" in section \"Modes\"";
  }


  std::vector<MeasuredShape>
  measured_shapes(const ModeParameters &parameters)
  {
    const std::vector<NamedPoint> points =
      parse_points(parameters.points, place_of_points);
    const std::string place = "\"Measured shapes\" in section \"Modes\"";
    std::vector<MeasuredShape> shapes;
    for (const std::string &item : split_list(parameters.shapes, ';'))
      {
        const auto    colon = item.find(':');
        MeasuredShape shape;
        shape.name = Utilities::trim(item.substr(0, colon));
        for (const std::string &part : split_list(
               colon == std::string::npos ? "" : item.substr(colon + 1)))
          {
            // the name of a point may have blanks
            const auto last   = part.rfind(' '),
                       before = last == std::string::npos || last == 0 ?
                                  last :
                                  part.rfind(' ', last - 1);
            MeasuredShape::Amplitude amplitude{0, 0, 0.};
            std::string              name;
            bool                     is_one = before != std::string::npos;
            if (is_one)
              {
                name = Utilities::trim(part.substr(0, before));
                const std::string direction =
                  part.substr(before + 1, last - before - 1);
                const auto value    = parse_number(part.substr(last + 1));
                amplitude.direction = std::string("xyz").find(direction);
                amplitude.value     = value.value_or(0.);
                is_one =
                  value && direction.size() == 1 && amplitude.direction < 3;
              }
            if (!is_one)
              throw UserError(place + ": \"" + part +
                              "\" is no amplitude; write \"point x 0.6\", with "
                              "the direction x, y or z.");
            const auto point =
              std::find_if(points.begin(), points.end(), [&](const auto &one) {
                return one.name == name;
              });
            if (point == points.end())
              throw UserError(place + ": \"" + name +
                              "\" is not among the \"Measured points\"; name "
                              "it there with its coordinates.");
            amplitude.point = point - points.begin();
            shape.amplitudes.push_back(amplitude);
          }
        if (std::none_of(shape.amplitudes.begin(),
                         shape.amplitudes.end(),
                         [](const auto &one) { return one.value != 0.; }))
          throw UserError(place + ": \"" + shape.name +
                          "\" has no amplitude other than zero; write \"" +
                          shape.name + ": point x 1, other point x 0.6\".");
        shapes.push_back(shape);
      }
    return shapes;
  }


  nlohmann::json
  nearest_mode(const unsigned int number,
               const double       frequency,
               const double       criterion)
  {
    return {{"mode", number},
            {"frequency [Hz]", frequency},
            {"modal assurance criterion [-]", criterion}};
  }


  MeasuredShapes::MeasuredShapes(const ModalModel     &model,
                                 const ModeParameters &parameters)
    : points(parse_points(parameters.points, place_of_points))
    , shapes(measured_shapes(parameters))
    , weights(model.solid.discretization, points, place_of_points)
  {}


  nlohmann::json
  MeasuredShapes::nearest(const std::vector<Mode> &modes) const
  {
    nlohmann::json result;
    if (shapes.empty())
      return result;
    std::vector<std::vector<Tensor<1, 3>>> displacements;
    for (const Mode &mode : modes)
      displacements.push_back(weights.value(mode.shape));
    for (const MeasuredShape &shape : shapes)
      {
        unsigned int nearest = 0;
        double       largest = -1.;
        for (unsigned int j = 0; j < modes.size(); ++j)
          {
            double mixed = 0., measured = 0., computed = 0.;
            for (const auto &[point, direction, value] : shape.amplitudes)
              {
                const double here = displacements[j][point][direction];
                mixed += value * here;
                measured += value * value;
                computed += here * here;
              }
            const double criterion =
              computed > 0. ? mixed * mixed / (measured * computed) : 0.;
            if (criterion > largest)
              {
                largest = criterion;
                nearest = j;
              }
          }
        result[shape.name] =
          nearest_mode(nearest + 1, modes[nearest].frequency, largest);
      }
    return result;
  }
} // namespace Voussoir
