#include <voussoir/base/error.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/driver/case_identity.h>
#include <voussoir/driver/strength_reduction.h>

#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    bool
    ends_with(const std::string &text, const std::string &end)
    {
      return text.size() >= end.size() &&
             text.compare(text.size() - end.size(), end.size(), end) == 0;
    }


    /** Whether an entry of a material or an interface is a strength. */
    bool
    is_strength(const std::string &entry)
    {
      if (entry.rfind("Materials/", 0) != 0 &&
          entry.rfind("Interfaces/", 0) != 0)
        return false;
      const std::string last = entry.substr(entry.rfind('/') + 1);
      for (const std::string part : {"trength",
                                     "ohesion",
                                     "riction",
                                     "cut-off",
                                     "nergy",
                                     "Yield stress"})
        if (last.find(part) != std::string::npos)
          return last != "Strength increase";
      return false;
    }
  } // namespace


  std::vector<std::string>
  strengths_left(const Case                     &parameters,
                 const std::vector<std::string> &reduced)
  {
    std::vector<std::string> result;
    for (const nlohmann::json &line : identity_of(parameters))
      {
        const std::string           text   = line;
        const auto                  equals = text.find(" =");
        const std::string           entry  = text.substr(0, equals);
        const std::optional<double> value =
          parse_number(Utilities::trim(text.substr(equals + 2)));
        if (is_strength(entry) && value && *value > 0. &&
            std::find(reduced.begin(), reduced.end(), entry) == reduced.end())
          result.push_back(entry + " = " + number_text(*value));
      }
    return result;
  }


  std::string
  reduced_strength(const std::string &entry,
                   const std::string &strength,
                   const std::string &divisor)
  {
    const std::optional<double> whole = parse_number(strength),
                                by    = parse_number(divisor);
    if (!whole)
      throw UserError(
        "\"Reduced strengths\" in section \"Study\" names \"" + entry +
        "\", to which this file gives no number; set it, or remove it there.");
    if (!is_strength(entry))
      throw UserError(
        "\"Reduced strengths\" in section \"Study\" names \"" + entry +
        "\", which is no strength, cohesion, friction or "
        "fracture energy of a material or an interface; remove it there, or "
        "vary it by \"Vary\".");
    if (!by || *by <= 0.)
      throw UserError("Section \"Study\" has a " + strength_reduction +
                      " of \"" + divisor + "\"; give numbers above 0.");
    if (ends_with(entry, "Friction angle"))
      {
        constexpr double degree = numbers::PI / 180.;
        return number_text(std::atan(std::tan(*whole * degree) / *by) / degree);
      }
    return number_text(*whole / *by);
  }
} // namespace Voussoir
