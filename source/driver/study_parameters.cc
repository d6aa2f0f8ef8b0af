#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/driver/study_parameters.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** An entry and the values it takes one after the other. */
    using VariedEntry = std::pair<std::string, std::vector<std::string>>;

    std::vector<VariedEntry>
    varied_entries(const std::string &text)
    {
      std::vector<VariedEntry> result;
      for (const std::string &part : split_list(text, ';'))
        {
          const auto equals = part.find('=');
          result.emplace_back(Utilities::trim(part.substr(0, equals)),
                              equals == std::string::npos ?
                                std::vector<std::string>() :
                                split_list(part.substr(equals + 1)));
          if (result.back().second.empty())
            throw UserError("\"Vary\" in section \"Study\" gives \"" +
                            result.back().first +
                            "\" no values; write \"Section/Entry = 1, 2\".");
        }
      return result;
    }
  } // namespace


  void
  StudyParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Vary",
      vary,
      "Entries of this file with the values they take, separated by "
      "semicolons, as in \"Ground motion/Overload factor = 1, 1.2, 1.4; "
      "Materials/rock/Young's modulus = 15e9, 20e9\". Each combination is a run "
      "of its own. \"" +
        strength_reduction + "\" divides what \"Reduced strengths\" names.");
    prm.add_parameter("Combination",
                      combination,
                      "Crossed: each value with each of the other entries. "
                      "Paired: the first values together, the second, ...",
                      Patterns::Selection("crossed|paired"));
    prm.add_parameter(
      "Reduced strengths",
      reduced,
      "Entries that the " + strength_reduction +
        " divides, separated by semicolons, as in \"Interfaces/planes/Friction "
        "coefficient; Interfaces/planes/Cohesion\".");
    prm.add_parameter(
      "Quantities",
      quantities,
      "Numbers of summary.json that make the columns of study.csv, by their "
      "paths, separated by semicolons; a star stands for any letters, and of "
      "several numbers the largest is taken, or the smallest if the name "
      "begins with that. Empty: displacements of the histories, opening, slip "
      "and safety of interfaces and blocks, energy lost in cracks.");
    prm.add_parameter("Ranks of a run",
                      ranks_of_run,
                      "Ranks that each run gets, so that several go on side by "
                      "side; 0: all, one run after the other.");

    prm.enter_subsection("Limit");
    prm.add_parameter("Entry",
                      varied_to_limit,
                      "What grows until a criterion is met, as \"Ground "
                      "motion/Overload factor\" or \"" +
                        strength_reduction +
                        "\", in each combination; empty: no limit is sought.");
    prm.add_parameter("From", from, "Value at which nothing happens yet.");
    prm.add_parameter("To", to, "Value at which the criterion is met.");
    prm.add_parameter("Accuracy",
                      accuracy,
                      "Width of the bracket at which the search ends.",
                      Patterns::Double(1e-9));
    prm.add_parameter(
      "Criterion",
      criterion,
      "What happens at the limit: \"PATH > VALUE\" or \"PATH < VALUE\" of a "
      "number of summary.json, or \"stopped\", for a run or a static stage that "
      "comes to no end; one of several, separated by semicolons, is enough.");
    prm.add_parameter("Extend",
                      extend,
                      "Goes beyond From and To where the limit is not between "
                      "them, by up to four times their distance.");
    prm.leave_subsection();
  }


  bool
  StudyParameters::wanted() const
  {
    return !vary.empty() || seeks_limit();
  }


  bool
  StudyParameters::seeks_limit() const
  {
    return !varied_to_limit.empty();
  }


  void
  StudyParameters::check() const
  {
    combinations();
    if (seeks_limit() && criteria().empty())
      throw UserError("\"Criterion\" in section \"Study/Limit\" is empty; say "
                      "what happens at the limit of \"" +
                      varied_to_limit + "\".");
    if (seeks_limit() && !(from < to))
      throw UserError(
        "\"From\" in section \"Study/Limit\" is not below \"To\"; "
        "give the smaller value first.");
    const std::string whole = vary + ";" + varied_to_limit;
    if (whole.find(strength_reduction) != std::string::npos && reduced.empty())
      throw UserError("Section \"Study\" has a " + strength_reduction +
                      ", but \"Reduced strengths\" names no entries.");
  }


  std::vector<StudyValues>
  StudyParameters::combinations() const
  {
    std::vector<StudyValues> result(1);
    bool                     first = true;
    for (const auto &[entry, values] : varied_entries(vary))
      {
        if (combination == "paired" && !first)
          {
            if (values.size() != result.size())
              throw UserError(
                "\"Vary\" in section \"Study\" pairs " +
                std::to_string(values.size()) + " values of \"" + entry +
                "\" with " + std::to_string(result.size()) + " of \"" +
                result[0][0].first +
                "\"; give as many, or set \"Combination = crossed\".");
            for (std::size_t i = 0; i < values.size(); ++i)
              result[i].emplace_back(entry, values[i]);
            continue;
          }
        std::vector<StudyValues> longer;
        for (const StudyValues &before : result)
          for (const std::string &value : values)
            {
              longer.push_back(before);
              longer.back().emplace_back(entry, value);
            }
        result = std::move(longer);
        first  = false;
      }
    return result;
  }


  std::vector<SummaryNumber>
  StudyParameters::numbers() const
  {
    static const std::string usual =
      "histories/*/largest displacement [m];"
      "interfaces/surfaces/*/largest opening [mm];"
      "interfaces/surfaces/*/residual slip [mm];"
      "interfaces/surfaces/*/slip rate at the end [mm/s];"
      "interfaces/blocks/*/smallest safety;"
      "energy balance/lost to cracks and plastic flow [J]";
    std::vector<SummaryNumber> result;
    for (const std::string &path :
         split_list(quantities.empty() ? usual : quantities, ';'))
      result.emplace_back(path);
    return result;
  }


  std::vector<Criterion>
  StudyParameters::criteria() const
  {
    std::vector<Criterion> result;
    for (const std::string &text : split_list(criterion, ';'))
      result.emplace_back(text, "\"Criterion\" in section \"Study/Limit\"");
    return result;
  }
} // namespace Voussoir
