#include <voussoir/base/error.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/driver/run_summary.h>
#include <voussoir/driver/summary_numbers.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace Voussoir
{
  namespace
  {
    /** The names along a path; a stroke in brackets is part of a unit. */
    std::vector<std::string>
    names_along(const std::string &path)
    {
      std::vector<std::string> names(1);
      bool                     in_unit = false;
      for (const char letter : path)
        {
          in_unit = letter == '[' || (in_unit && letter != ']');
          if (letter == '/' && !in_unit)
            names.emplace_back();
          else
            names.back() += letter;
        }
      return names;
    }


    /** Whether a name is that of a pattern with stars. */
    bool
    fits(const std::string_view name, const std::string_view pattern)
    {
      if (pattern.empty() || name.empty())
        return name.empty() &&
               pattern.find_first_not_of('*') == std::string_view::npos;
      if (pattern[0] == '*')
        return fits(name, pattern.substr(1)) || fits(name.substr(1), pattern);
      return name[0] == pattern[0] && fits(name.substr(1), pattern.substr(1));
    }


    void
    collect(const nlohmann::json           &part,
            const std::vector<std::string> &names,
            const std::size_t               depth,
            std::vector<double>            &found)
    {
      if (depth == names.size() && part.is_number())
        found.push_back(part.get<double>());
      if (depth == names.size() || !part.is_structured())
        return;
      for (const auto &[name, value] : part.items())
        if (fits(name, names[depth]))
          collect(value, names, depth + 1, found);
    }
  } // namespace


  bool
  is_smallest(const std::string &path)
  {
    return names_along(path).back().rfind("smallest", 0) == 0;
  }


  std::string
  number_text(const double value)
  {
    std::ostringstream text;
    text << std::setprecision(6) << value;
    return text.str();
  }


  SummaryNumber::SummaryNumber(const std::string &path)
    : path(path)
    , names(names_along(path))
  {}


  std::optional<double>
  SummaryNumber::in(const nlohmann::json &summary) const
  {
    std::vector<double> found;
    collect(summary, names, 0, found);
    if (found.empty())
      return {};
    return is_smallest(path) ? *std::min_element(found.begin(), found.end()) :
                               *std::max_element(found.begin(), found.end());
  }


  Criterion::Criterion(const std::string &text, const std::string &place)
    : text(text)
  {
    if (text == "stopped")
      return;
    const auto sign = text.find_last_of("<>");
    if (sign != std::string::npos)
      {
        const std::optional<double> value =
          parse_number(dealii::Utilities::trim(text.substr(sign + 1)));
        number.emplace(dealii::Utilities::trim(text.substr(0, sign)));
        above = text[sign] == '>';
        limit = value.value_or(0.);
        if (value && !number->path.empty())
          return;
      }
    throw UserError(place + " has \"" + text +
                    "\"; write \"PATH > VALUE\" or \"PATH < VALUE\" with the "
                    "path of a number in summary.json, as \"histories/crest/"
                    "largest displacement [m] > 0.1\", or \"stopped\".");
  }


  std::pair<std::optional<double>, bool>
  Criterion::look(const RunSummary &summary) const
  {
    const bool was_stopped = summary.end == RunEnd::stopped;
    if (!number)
      return {{}, was_stopped};
    const std::optional<double> value = number->in(summary);
    if (!value && !was_stopped)
      throw UserError("The summary of the run has no number \"" + number->path +
                      "\"; take one that its summary.json has, "
                      "or add the observer that gives it.");
    return {value, value && (above ? *value > limit : *value < limit)};
  }
} // namespace Voussoir
