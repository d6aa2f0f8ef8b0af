#include <voussoir/base/error.h>
#include <voussoir/base/parameter_section.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/acceptance.h>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    nlohmann::json
    line(const double value, const bool is_upper, const double limit)
    {
      return {{"value", std::isfinite(value) ? nlohmann::json(value) : nullptr},
              {is_upper ? "at most" : "at least", limit},
              {"met", is_upper ? value <= limit : value >= limit}};
    }


    std::vector<std::string>
    names_with(const nlohmann::json &table, const nlohmann::json &met)
    {
      std::vector<std::string> names;
      for (const auto &[name, line] : table.items())
        if (line.at("met") == met)
          names.push_back(name);
      return names;
    }
  } // namespace


  nlohmann::json
  at_most(const double value, const double limit)
  {
    return line(value, true, limit);
  }


  nlohmann::json
  at_least(const double value, const double limit)
  {
    return line(value, false, limit);
  }


  nlohmann::json
  without_limit(const double value)
  {
    return {{"value", value}, {"met", nullptr}};
  }


  std::vector<std::string>
  not_met(const nlohmann::json &table)
  {
    return names_with(table, false);
  }


  std::vector<std::string>
  not_judged(const nlohmann::json &table)
  {
    return names_with(table, nullptr);
  }


  void
  AcceptanceParameters::declare(ParameterHandler    &prm,
                                const ParameterFile &file)
  {
    prm.add_parameter("Names",
                      names,
                      "Names of the criteria, separated by commas; each has a "
                      "section of that name here. They are compared with the "
                      "results in the acceptance table.");
    prm.add_parameter(
      "Load cases",
      load_cases,
      "Load cases of this run, as \"static usual, MCE, after the earthquake\": "
      "criteria of other load cases are left out, so that one file can hold "
      "those of all. Empty: all.",
      Patterns::MultipleSelection(
        "static usual|static unusual|OBE|MDE|MCE|after the earthquake"));
    for (const std::string &name : split_list(file.given("Acceptance/Names")))
      {
        AcceptanceCriterion &criterion = criteria.emplace_back();
        criterion.name                 = name;
        in_section(prm, name, [&] {
          prm.add_parameter("Clause",
                            criterion.clause,
                            "Basis of the criterion as free text: the clause "
                            "of a code, or of the owner's specification.");
          add_option(prm,
                     "Load case",
                     criterion.load_case,
                     "Load case to which the criterion applies.");
          prm.add_parameter(
            "Quantity",
            criterion.quantity,
            "A number of summary.json by its path, as in the \"Quantities\" of "
            "section \"Study\".");
          prm.add_parameter("At most",
                            criterion.at_most,
                            "Upper limit of the quantity, in the unit of the "
                            "quantity.");
          prm.add_parameter("At least",
                            criterion.at_least,
                            "Lower limit of the quantity; give either this "
                            "or \"At most\".");
          prm.add_parameter("Source",
                            criterion.source,
                            "Document from which the limit is taken, or "
                            "\"user's\" for a limit of your own.");
        });
      }
  }


  void
  AcceptanceParameters::check() const
  {
    for (const AcceptanceCriterion &criterion : criteria)
      {
        const std::string place =
          "section \"Acceptance/" + criterion.name + "\"";
        if (criterion.quantity.empty())
          throw UserError("\"Quantity\" in " + place +
                          " is empty; give the path of a number in "
                          "summary.json, as \"histories/crest/largest "
                          "displacement [m]\".");
        if (criterion.at_most.empty() == criterion.at_least.empty())
          throw UserError("Exactly one of \"At most\" and \"At least\" in " +
                          place + " must be given.");
        for (const std::string &limit : {criterion.at_most, criterion.at_least})
          if (!limit.empty() && !parse_number(limit))
            throw UserError("The limit \"" + limit + "\" in " + place +
                            " is no number; give it in the unit of the "
                            "quantity.");
        if (criterion.source.empty())
          throw UserError("\"Source\" in " + place +
                          " is empty; give the document of the limit, or "
                          "\"user's\".");
      }
    if (!criteria.empty() && of_the_run().empty())
      throw UserError(
        "None of the criteria in section \"Acceptance\" applies to "
        "its \"Load cases\", \"" +
        load_cases +
        "\"; add the \"Load case\" of one of them, or leave "
        "\"Load cases\" empty.");
  }


  std::vector<AcceptanceCriterion>
  AcceptanceParameters::of_the_run() const
  {
    const auto                       wanted = split_list(load_cases);
    std::vector<AcceptanceCriterion> result;
    for (const AcceptanceCriterion &criterion : criteria)
      if (wanted.empty() ||
          std::find(wanted.begin(),
                    wanted.end(),
                    option_name(criterion.load_case)) != wanted.end())
        result.push_back(criterion);
    return result;
  }


  nlohmann::json
  AcceptanceParameters::table(const nlohmann::json &summary) const
  {
    nlohmann::json result;
    for (const AcceptanceCriterion &criterion : of_the_run())
      {
        const SummaryNumber quantity(criterion.quantity);
        const bool          is_upper = !criterion.at_most.empty();
        // of several numbers the least favourable one
        const auto   found = quantity.find(summary, !is_upper);
        const double limit =
          *parse_number(is_upper ? criterion.at_most : criterion.at_least);
        nlohmann::json &line = result[criterion.name];
        line                 = {{"clause", criterion.clause},
                                {"load case", option_name(criterion.load_case)},
                                {"quantity", criterion.quantity},
                                {"source", criterion.source},
                                {is_upper ? "at most" : "at least", limit},
                                {"demand", nullptr},
                                {"met", nullptr}};
        if (!found)
          continue;
        line["demand"] = found->value;
        line["met"] =
          (is_upper ? at_most : at_least)(found->value, limit)["met"];
        if (criterion.quantity.find('*') != std::string::npos)
          line["of"] = join(found->names, "/");
        if (!found->time.is_null())
          line["at the time [s]"] = found->time;
        if (!found->place.is_null())
          line["at [m]"] = found->place;
      }
    return result;
  }
} // namespace Voussoir
