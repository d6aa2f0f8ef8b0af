#include <voussoir/base/parse_numbers.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/sensitivity.h>

#include <cmath>

namespace Voussoir
{
  namespace
  {
    /** Whether an entry is part of the model, not of its evaluation. */
    bool
    is_of_the_case(const std::string &entry)
    {
      for (const char *const section :
           {"Study/", "Output/", "Acceptance/", "Material test/"})
        if (entry.rfind(section, 0) == 0)
          return false;
      return true;
    }
  } // namespace


  std::vector<MovedNumber>
  moved_numbers(const ParameterFile            &file,
                const dealii::ParameterHandler &prm,
                const StudyParameters          &parameters)
  {
    const auto               patterns = split_list(parameters.moved, ';');
    std::vector<MovedNumber> result;
    for (const std::string &entry : file.given_numbers(prm))
      {
        if (!is_of_the_case(entry) ||
            std::none_of(patterns.begin(),
                         patterns.end(),
                         [&entry](const std::string &pattern) {
                           return fits(entry, pattern);
                         }))
          continue;
        const std::vector<std::string> given = split_list(file.given(entry));
        for (std::size_t i = 0; i < given.size(); ++i)
          {
            const double value = parse_number(given[i]).value();
            for (const double change : {-parameters.change, parameters.change})
              if (value != 0.)
                {
                  std::vector<std::string> texts = given;
                  texts[i] = number_text(value * (1. + change), fine_digits);
                  result.push_back(
                    {entry,
                     value,
                     entry + (given.size() > 1 ?
                                ", number " + std::to_string(i + 1) :
                                std::string()),
                     change,
                     join(texts, ", ")});
                }
          }
      }
    return result;
  }


  Sensitivity::Sensitivity(const double as_given,
                           const std::vector<std::pair<double, double>> &moved)
  {
    std::vector<std::pair<double, double>> points{{0., as_given}};
    points.insert(points.end(), moved.begin(), moved.end());
    double magnitude = std::abs(as_given);
    if (magnitude == 0.)
      for (const auto &point : points)
        magnitude = std::max(magnitude, std::abs(point.second));
    if (magnitude == 0. || moved.empty())
      return;
    const auto [least, largest] =
      std::minmax_element(points.begin(), points.end());
    per_change = (largest->second - least->second) /
                 (largest->first - least->first) / magnitude;
    for (const auto &point : points)
      largest_change =
        std::max(largest_change, std::abs(point.second - as_given) / magnitude);
  }
} // namespace Voussoir
