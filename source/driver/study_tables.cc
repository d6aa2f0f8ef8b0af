#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/study.h>
#include <voussoir/driver/study_statistics.h>
#include <voussoir/files/table.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** The criteria met; "none" if none is, empty if that is unknown. */
    std::string
    text_of(const std::optional<std::vector<std::string>> &met)
    {
      return !met ? "" : met->empty() ? "none" : join(*met, "; ");
    }


    nlohmann::json
    as_object(const StudyValues &values)
    {
      nlohmann::json object = nlohmann::json::object();
      for (const auto &[entry, value] : values)
        object[entry] = value;
      return object;
    }


    std::string
    csv_of(const std::vector<nlohmann::ordered_json> &lines)
    {
      std::vector<std::string> heading;
      for (const auto &item : lines.at(0).items())
        heading.push_back(item.key());
      std::string text = csv_heading(heading) + '\n';
      for (const nlohmann::ordered_json &line : lines)
        {
          std::vector<std::string> columns;
          for (const nlohmann::ordered_json &value : line)
            columns.push_back(value.is_string() ? value.get<std::string>() :
                              value.is_null()   ? std::string() :
                                                  number_text(value));
          text += csv_heading(columns) + '\n';
        }
      return text;
    }


    /** A table evaluated from the runs, in sentences for the log. */
    std::vector<std::string>
    in_words(const std::vector<nlohmann::ordered_json> &lines)
    {
      constexpr std::size_t    most = 20;
      std::vector<std::string> result;
      for (const nlohmann::ordered_json &line : lines)
        {
          const auto value = [&line](const char *name) {
            return number_text(line.at(name));
          };
          std::string text;
          if (line.contains("median"))
            text = line.at("median").is_null() ?
                     line.at("verdict").get<std::string>() :
                     "median " + value("median") + " (" + value("median from") +
                       " to " + value("median to") + "), dispersion " +
                       value("dispersion") + " (" + value("dispersion from") +
                       " to " + value("dispersion to") + ")";
          else if (line.contains("found"))
            text = line.at("number").get<std::string>() + ": " +
                   line.at("verdict").get<std::string>() + ", " +
                   value("found") + " within a standard error of " +
                   value("standard error [%]") + " %";
          else if (line.contains("number"))
            text = line.at("number").get<std::string>() + ": " +
                   line.at("quantity").get<std::string>() + " changes by " +
                   value("largest change [%]") + " %";
          else
            {
              text = line.at("quantity").get<std::string>() + ": " +
                     line.at("verdict").get<std::string>();
              if (!line.at("extrapolated").is_null())
                text += ", " + value("fine") + " within " +
                        value("band about the fine one") + ", extrapolated " +
                        value("extrapolated");
            }
          StudyValues others; // paths with a section are entries
          for (const auto &item : line.items())
            if (item.key().find('/') != std::string::npos)
              others.emplace_back(item.key(), item.value());
          if (!others.empty())
            text = description(others) + ": " + text;
          if (result.empty() || result.back() != text)
            result.push_back(text);
        }
      if (result.size() > most)
        {
          result.resize(most);
          result.emplace_back("...");
        }
      return result;
    }
  } // namespace


  void
  Study::write_tables() const
  {
    if (Utilities::MPI::this_mpi_process(communicator) > 0)
      return;
    std::map<std::string, std::string> files{{"/study.csv", table()},
                                             {"/study.json",
                                              all_results().dump(2) + '\n'}};
    if (!parameters.spread.empty() &&
        !std::all_of(outcomes.begin(), outcomes.end(), [](const Outcome &run) {
          return run.summary.end == RunEnd::failed;
        }))
      files["/study_statistics.csv"] = statistics();
    for (const auto &[name, lines] :
         {std::pair("/study_convergence.csv", convergence()),
          std::pair("/study_fragility.csv", fragility()),
          std::pair("/study_sensitivity.csv", sensitivities()),
          std::pair("/study_calibration.csv", calibrations)})
      if (!lines.empty())
        {
          files[name] = csv_of(lines);
          report(join(in_words(lines), "\n"));
        }
    for (const auto &[name, text] : files)
      if (const std::string reason = write_file(folder + name, text);
          !reason.empty())
        throw UserError("\"" + folder + name + "\" cannot be written because " +
                        reason + ".");
    report("The study is in " + folder + "/study.csv and study.json");
  }


  // Table of the limits, if they are sought, and of the runs otherwise.
  std::string
  Study::statistics() const
  {
    std::vector<StudySample> samples;
    std::vector<std::string> names;
    if (parameters.seeks_limit())
      {
        names = {"limit of " + parameters.varied_to_limit};
        for (const Limit &limit : limits)
          samples.push_back(
            {limit.values, {0.5 * (limit.fails + limit.meets)}});
      }
    else
      {
        const std::vector<SummaryNumber> numbers = parameters.numbers();
        for (const SummaryNumber &number : numbers)
          names.push_back(number.path);
        for (const Outcome &outcome : outcomes)
          {
            // a failed run does not count as beyond the others
            if (outcome.summary.end == RunEnd::failed)
              continue;
            samples.push_back({outcome.values, {}});
            for (const SummaryNumber &number : numbers)
              samples.back().quantities.push_back(number.in(outcome.numbers));
          }
      }
    return statistics_table(samples, parameters.spread_entries(), names);
  }


  std::string
  Study::table() const
  {
    const std::vector<SummaryNumber> numbers = parameters.numbers();
    const auto                       is_in   = [](const SummaryNumber &number) {
      return [&number](const Outcome &outcome) {
        return number.in(outcome.numbers).has_value();
      };
    };
    std::vector<std::string> heading;
    for (const auto &item : shown(outcomes.at(0).values))
      heading.push_back(item.first);
    std::vector<const SummaryNumber *> columns;
    for (const SummaryNumber &number : numbers)
      if (std::any_of(outcomes.begin(), outcomes.end(), is_in(number)))
        {
          columns.push_back(&number);
          heading.push_back(number.path);
        }
    if (parameters.seeks_limit())
      heading.push_back("criterion met");
    heading.push_back("verdict");
    std::string text = csv_heading(heading) + '\n';
    for (const Outcome &outcome : outcomes)
      {
        std::vector<std::string> line;
        for (const auto &item : shown(outcome.values))
          line.push_back(item.second);
        for (const SummaryNumber *number : columns)
          {
            const std::optional<double> value = number->in(outcome.numbers);
            line.push_back(value ? number_text(*value) : "");
          }
        if (parameters.seeks_limit())
          line.push_back(
            text_of(met_criteria(parameters.criteria(), outcome.summary)));
        line.push_back(outcome.summary.short_verdict());
        text += csv_heading(line) + '\n';
      }
    return text;
  }


  nlohmann::json
  Study::all_results() const
  {
    nlohmann::json all{{"runs", nlohmann::json::array()}};
    for (const Outcome &outcome : outcomes)
      {
        nlohmann::json run{{"folder", outcome.folder},
                           {"verdict", outcome.summary.verdict()},
                           {"values", as_object(shown(outcome.values))}};
        for (const SummaryNumber &number : parameters.numbers())
          if (const std::optional<double> value = number.in(outcome.numbers))
            run["quantities"][number.path] = *value;
        if (parameters.seeks_limit())
          if (const std::string met =
                text_of(met_criteria(parameters.criteria(), outcome.summary));
              !met.empty())
            run["criterion met"] = met;
        all["runs"].push_back(run);
      }
    if (parameters.reduces_strengths())
      all[strength_reduction] = {{"divides",
                                  split_list(parameters.reduced, ';')},
                                 {"leaves as they are", strengths_kept}};
    for (const Limit &limit : limits)
      all["limits"].push_back({{"of", parameters.varied_to_limit},
                               {"criterion", parameters.criterion},
                               {"not met at", limit.fails},
                               {"met at", limit.meets},
                               {"values", as_object(limit.values)}});
    if (const Table lines = convergence(); !lines.empty())
      all["convergence"] = lines;
    if (const Table lines = fragility(); !lines.empty())
      all["fragility"] = {{"intensity", parameters.intensity},
                          {"criterion", parameters.fragility_criterion},
                          {"confidence", parameters.confidence},
                          {"levels", lines}};
    if (!calibrations.empty())
      all["calibration"] = {{"error", parameters.measurement_error},
                            {"lines", calibrations}};
    if (const Table lines = sensitivities(); !lines.empty())
      all["sensitivity"] = {{"change", parameters.change},
                            {"refused", refused_moves},
                            {"numbers", lines}};
    return all;
  }
} // namespace Voussoir
