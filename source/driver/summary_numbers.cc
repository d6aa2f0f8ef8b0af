#include <voussoir/base/error.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/run_summary.h>
#include <voussoir/driver/summary_numbers.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <functional>
#include <iomanip>
#include <sstream>

namespace Voussoir
{
  namespace
  {
    /** The names along a path; a slash in brackets is part of a unit. */
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


    /** Visits the values that match the rest of a path, with their object and
     *  the names along the path. */
    void
    visit(const nlohmann::json                                    &part,
          const nlohmann::json                                    *around,
          const std::vector<std::string>                          &names,
          std::vector<std::string>                                &way,
          const std::function<void(const nlohmann::json &value,
                                   const nlohmann::json &around)> &action)
    {
      if (way.size() == names.size())
        {
          if (around != nullptr && !part.is_structured())
            action(part, *around);
          return;
        }
      if (!part.is_structured())
        return;
      for (const auto &[name, value] : part.items())
        if (fits(name, names[way.size()]))
          {
            way.push_back(name);
            visit(value, &part, names, way, action);
            way.pop_back();
          }
    }


    /** Paths of all numbers of a summary. */
    void
    add_paths(const nlohmann::json     &part,
              const std::string        &path,
              std::vector<std::string> &paths)
    {
      if (!part.is_structured())
        paths.push_back(path);
      else
        for (const auto &[name, child] : part.items())
          add_paths(child, path.empty() ? name : path + "/" + name, paths);
    }


    bool
    is_extreme(const std::string &name)
    {
      return name.rfind("largest", 0) == 0 || name.rfind("smallest", 0) == 0;
    }


    /** The value beside a number under a name of its own, or under a name of
     *  the object, which belongs to the extreme of the object if it has one;
     *  else null. */
    nlohmann::json
    beside(const nlohmann::json &around,
           const std::string    &number,
           const std::string    &own_name,
           const std::string    &name)
    {
      if (!around.is_object())
        return {};
      if (around.contains(own_name))
        return around.at(own_name);
      const auto items = around.items();
      const bool is_its =
        is_extreme(number) ||
        std::none_of(items.begin(), items.end(), [](const auto &item) {
          return item.value().is_number() && is_extreme(item.key());
        });
      return is_its && around.contains(name) ? around.at(name) :
                                               nlohmann::json();
    }
  } // namespace


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


  bool
  is_smallest(const std::string &path)
  {
    return names_along(path).back().rfind("smallest", 0) == 0;
  }


  std::string
  number_text(const double value, const int digits)
  {
    std::ostringstream text;
    text << std::setprecision(digits) << value;
    return text.str();
  }


  SummaryNumber::SummaryNumber(const std::string &path)
    : path(path)
    , names(names_along(path))
  {}


  std::optional<SummaryNumber::Found>
  SummaryNumber::find(const nlohmann::json &summary) const
  {
    return find(summary, is_smallest(path));
  }


  std::optional<SummaryNumber::Found>
  SummaryNumber::find(const nlohmann::json &summary, const bool smallest) const
  {
    std::optional<Found>     found;
    std::vector<std::string> way;
    visit(summary,
          nullptr,
          names,
          way,
          [&](const nlohmann::json &value, const nlohmann::json &around) {
            if (!value.is_number())
              return;
            const double number = value;
            if (found &&
                !(smallest ? number < found->value : number > found->value))
              return;
            const std::string name = dealii::Utilities::trim(
              way.back().substr(0, way.back().find('[')));
            found = {
              number,
              way,
              beside(around,
                     name,
                     "time of the " + name + " [s]",
                     "at the time [s]"),
              beside(around, name, "place of the " + name + " [m]", "at [m]")};
          });
    return found;
  }


  std::optional<double>
  SummaryNumber::in(const nlohmann::json &summary) const
  {
    if (const std::optional<Found> found = find(summary))
      return found->value;
    return {};
  }


  bool
  SummaryNumber::is_in(const nlohmann::json &summary) const
  {
    bool                     any = false;
    std::vector<std::string> way;
    visit(summary,
          nullptr,
          names,
          way,
          [&](const nlohmann::json &value, const nlohmann::json &) {
            any = any || value.is_number() || value.is_null();
          });
    return any;
  }


  void
  check_numbers(const NamedNumbers &wanted, const nlohmann::json &summary)
  {
    std::vector<std::string> known;
    add_paths(summary, "", known);
    for (const auto &[number, entry] : wanted)
      {
        if (number.is_in(summary))
          continue;
        const std::string closest = closest_match(number.path, known);
        throw UserError(
          entry + " names \"" + number.path +
          "\", which the summary of this case will not have" +
          (closest.empty() ? "" : " (did you mean \"" + closest + "\"?)") +
          "; take a number that it has, or add the observer that "
          "gives it.");
      }
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


  const SummaryNumber *
  Criterion::about() const
  {
    return number ? &*number : nullptr;
  }


  std::pair<std::optional<double>, bool>
  Criterion::evaluate(const RunSummary &summary) const
  {
    const bool was_stopped = summary.end == RunEnd::stopped;
    if (!number)
      return {{}, was_stopped};
    const std::optional<double> value = number->in(summary);
    if (!value && !was_stopped)
      throw UserError("The summary of the run has no number \"" + number->path +
                      "\"; take a number that its summary.json has, or add "
                      "the observer that writes it.");
    return {value, value && (above ? *value > limit : *value < limit)};
  }


  std::optional<std::vector<std::string>>
  met_criteria(const std::vector<Criterion> &criteria,
               const RunSummary             &summary)
  {
    if (summary.end == RunEnd::failed)
      return {};
    std::vector<std::string> met;
    for (const Criterion &criterion : criteria)
      try
        {
          if (criterion.evaluate(summary).second)
            met.push_back(criterion.text);
        }
      catch (const UserError &)
        {
          return {};
        }
    if (met.empty() && summary.end == RunEnd::stopped)
      return {};
    return met;
  }
} // namespace Voussoir
