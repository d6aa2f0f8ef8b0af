#include <voussoir/base/error.h>
#include <voussoir/base/parameter_entries.h>
#include <voussoir/base/parameter_section.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/base/text.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

namespace Voussoir
{
  namespace
  {
    // Whether the value is a number or a list of numbers of which one is larger
    // than any quantity.
    bool
    is_too_large(const std::string &pattern, const std::string &value)
    {
      if (pattern.find("[Double") == std::string::npos)
        return false;
      const auto parts = split_list(value);
      return std::any_of(parts.begin(), parts.end(), [](const auto &part) {
        return std::abs(std::atof(part.c_str())) > largest_number;
      });
    }


    // "a whole number from 1 to 4" for "[Integer range 1...4 (inclusive)]",
    // deal.II's description of a pattern; empty if the pattern is no number.
    std::string
    number_in_words(const std::string &pattern)
    {
      static const std::regex number(
        "\\[(Double|Integer)(?: range)?(?: (\\S*?)\\.\\.\\.(\\S+))?.*\\]");
      static const std::set<std::string> unbounded{
        "", "-MAX_DOUBLE", "MAX_DOUBLE", "-2147483648", "2147483647"};
      std::smatch parts;
      if (!std::regex_match(pattern, parts, number))
        return "";
      const std::string from = parts[2], to = parts[3];
      const bool        is_from = unbounded.count(from) == 0;
      const bool        is_to   = unbounded.count(to) == 0;
      return std::string(parts[1] == "Integer" ? "a whole number" :
                                                 "a number") +
             (is_from ? " from " + from : "") +
             (is_from != is_to ? " up" : "") + (is_to ? " to " + to : "");
    }

    // The end of a sentence that refuses a value.
    std::string
    what_is_allowed(const std::string &pattern, const std::string &value)
    {
      static const std::regex selection("\\[(Multiple)?Selection (.*?) ?\\]");
      static const std::regex list(
        "\\[List of <(.*)> of length ([0-9]+)\\.\\.\\.([0-9]+).*\\]");
      std::smatch parts;
      if (const std::string number = number_in_words(pattern); !number.empty())
        return "; it must be " + number;
      if (std::regex_match(pattern, parts, selection))
        {
          const auto  known = split_list(parts[2], '|');
          std::string wrong = value;
          if (parts[1].matched)
            for (const std::string &part : split_list(value))
              if (std::find(known.begin(), known.end(), part) == known.end())
                wrong = part;
          return known_names(wrong, known);
        }
      if (std::regex_match(pattern, parts, list) &&
          !number_in_words(parts[1]).empty())
        return "; it must be " +
               (parts[2] == parts[3] ? parts[2].str() + " values" :
                                       std::string("values")) +
               " separated by commas, each " + number_in_words(parts[1]);
      return "; allowed is: " +
             dealii::Patterns::pattern_factory(pattern)->description(
               dealii::Patterns::PatternBase::Text);
    }
  } // namespace


  std::string
  section_of(const std::string &path)
  {
    const auto slash = path.rfind('/');
    return slash == std::string::npos ? "" : path.substr(0, slash);
  }


  std::string
  entry_of(const std::string &path)
  {
    return path.substr(path.rfind('/') + 1);
  }


  std::string
  section_text(const std::string &section)
  {
    return section.empty() ? "at the top level" :
                             "in section \"" + section + "\"";
  }


  std::string
  new_name_of(const std::string &path)
  {
    static const std::map<std::string, std::string> renamed{
      {"Modes/Held materials", "Fixed materials"}};
    const auto entry = renamed.find(path);
    return entry == renamed.end() ? "" : entry->second;
  }


  std::map<std::string, DeclaredEntry>
  declared_entries(const dealii::ParameterHandler &prm)
  {
    std::ostringstream text;
    prm.print_parameters(text, dealii::ParameterHandler::JSON);
    std::map<std::string, DeclaredEntry> entries;

    const std::function<void(const nlohmann::json &, const std::string &)>
      collect = [&](const nlohmann::json &node, const std::string &section) {
        for (const auto &[name, child] : node.items())
          {
            const std::string path =
              section.empty() ? name : section + "/" + name;
            if (child.contains("value") && child["value"].is_string())
              entries[path] = {section,
                               dealii::Patterns::pattern_factory(
                                 child["pattern_description"])};
            else if (child.is_object())
              collect(child, path);
          }
      };
    collect(nlohmann::json::parse(text.str()), "");
    return entries;
  }


  void
  set_entry(dealii::ParameterHandler            &prm,
            const std::string                   &path,
            const std::string                   &text,
            const std::string                   &place,
            const dealii::Patterns::PatternBase &pattern)
  {
    const std::string section = section_of(path);
    const auto        refuse  = [&](const std::string &remedy) {
      throw UserError(place + ": \"" + entry_of(path) + "\" " +
                      section_text(section) + " cannot be \"" + text + "\"" +
                      remedy + ".");
    };
    const std::string allowed = pattern.description();
    if (!pattern.match(text))
      refuse(what_is_allowed(allowed, text));
    if (is_too_large(allowed, text))
      refuse("; no quantity in SI units is beyond 1e30");

    in_section(prm, section, [&] {
      try
        {
          prm.set(entry_of(path), text);
        }
      catch (const std::exception &)
        {
          // a value that matches the pattern but cannot be stored in the
          // variable
          refuse(what_is_allowed(allowed, text));
        }
    });
  }
} // namespace Voussoir
