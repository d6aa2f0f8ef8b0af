#include <voussoir/base/error.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/case_identity.h>
#include <voussoir/driver/simulation.h>
#include <voussoir/driver/strength_reduction.h>
#include <voussoir/driver/study.h>
#include <voussoir/driver/study_statistics.h>
#include <voussoir/files/table.h>
#include <voussoir/output/checkpoint.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    /** "Overload factor = 1.2, Young's modulus = 15e9". */
    std::string
    description(const StudyValues &values)
    {
      std::vector<std::string> parts;
      for (const auto &[entry, value] : values)
        parts.push_back(entry.substr(entry.rfind('/') + 1) + " = " + value);
      return join(parts, ", ");
    }


    /** The same without characters that the name of a folder cannot have. */
    std::string
    folder_name(const StudyValues &values)
    {
      std::string name;
      for (const char letter : description(values))
        if (std::isalnum(static_cast<unsigned char>(letter)) || letter == '.' ||
            letter == '+' || letter == '-')
          name += letter;
        else if (letter == ',')
          name += '_';
        else if (!name.empty() && name.back() != '-' && name.back() != '_')
          name += '-';
      return name.empty() ? "run" : name;
    }


    /** What a file holds on the first rank; empty: nothing, or no file. */
    std::string
    read_text(const std::string &name, const MPI_Comm communicator)
    {
      std::string text;
      if (Utilities::MPI::this_mpi_process(communicator) == 0)
        {
          std::ifstream in(name);
          text.assign(std::istreambuf_iterator<char>(in), {});
        }
      return Utilities::MPI::broadcast(communicator, text);
    }


    /** What a study has noted of a run: "identity" and, once the run has ended,
     *  "summary". Null: the run has not been begun. */
    nlohmann::json
    read_record(const std::string &name, const MPI_Comm communicator)
    {
      const std::string text = read_text(name, communicator);
      if (text.empty())
        return {};
      const auto json = nlohmann::json::parse(text, nullptr, false);
      if (json.is_object() && json.contains("identity") &&
          (!json.contains("summary") || is_summary(json.at("summary"))))
        return json;
      throw UserError("\"" + name +
                      "\" is not what a study notes of a run, or was changed; "
                      "remove it, and the study does this run again.");
    }


    /** What became of a run, without the advice that follows. */
    std::string
    verdict_of(const RunSummary &summary)
    {
      const std::string verdict = summary.verdict();
      return verdict.substr(0, verdict.find(". "));
    }


    /** Refuses a run that has been done with other entries. */
    void
    check_same(const nlohmann::json &recorded,
               const nlohmann::json &now,
               const std::string    &run_folder)
    {
      const std::string remedy =
        "; choose another \"Folder\" in section \"Output\" for the study, or "
        "\"--overwrite\".";
      if (!recorded.is_array())
        throw UserError("The run in \"" + run_folder +
                        "\" has been done by an earlier version of the "
                        "program, which did not note its entries" +
                        remedy);
      if (const auto difference = first_difference(recorded, now))
        throw UserError("The run in \"" + run_folder +
                        "\" has been done with \"" + difference->first +
                        "\", the study now has \"" + difference->second + "\"" +
                        remedy);
    }


    /** The criteria that a run meets, in words; "none". Empty: it has not
     * ended, or lacks their numbers. */
    std::string
    met_criteria(const std::vector<Criterion> &criteria,
                 const RunSummary             &summary)
    {
      if (summary.end == RunEnd::failed)
        return "";
      std::vector<std::string> met;
      for (const Criterion &criterion : criteria)
        try
          {
            if (criterion.evaluate(summary).second)
              met.push_back(criterion.text);
          }
        catch (const UserError &)
          {
            return "";
          }
      return met.empty() ? "none" : join(met, "; ");
    }


    /** Values of entries in their order, numbers by their size. */
    bool
    comes_before(const StudyValues &a, const StudyValues &b)
    {
      for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        if (a[i].second != b[i].second)
          {
            const auto x = parse_number(a[i].second),
                       y = parse_number(b[i].second);
            return x && y ? *x < *y : a[i].second < b[i].second;
          }
      return a.size() < b.size();
    }


    nlohmann::json
    as_object(const StudyValues &values)
    {
      nlohmann::json object = nlohmann::json::object();
      for (const auto &[entry, value] : values)
        object[entry] = value;
      return object;
    }
  } // namespace


  Study::Outcome::Outcome(const StudyValues &values,
                          const std::string &folder,
                          const RunSummary  &summary)
    : values(values)
    , folder(folder)
    , summary(summary)
    , numbers(summary)
  {}


  Study::Study(const ParameterFile &file,
               const RunOptions    &options,
               const MPI_Comm       communicator)
    : file(file)
    , options(options)
    , communicator(communicator)
  {
    const Case whole(file);
    parameters = whole.study;
    if (parameters.reduces_strengths())
      strengths_kept =
        strengths_left(whole, split_list(parameters.reduced, ';'));
    folder = whole.output.folder.empty() ? "output/" + file.name() :
                                           whole.output.folder;
    if (fs::exists(folder + "/parameters.prm"))
      throw UserError("The folder \"" + folder +
                      "\" is that of a single run; choose another \"Folder\" "
                      "in section \"Output\" for the study.");
    for (const ParameterFile &planned : planned_runs())
      Case checked(planned);

    const unsigned int n_ranks = Utilities::MPI::n_mpi_processes(communicator),
                       me      = Utilities::MPI::this_mpi_process(communicator),
                       of_run  = parameters.ranks_of_run == 0 ?
                                   n_ranks :
                                   std::min(parameters.ranks_of_run, n_ranks);
    n_groups                   = n_ranks / of_run;
    my_group                   = std::min(me / of_run, n_groups - 1);
    MPI_Comm_split(communicator, my_group, me, &group);
  }


  Study::~Study()
  {
    MPI_Comm_free(&group);
  }


  std::vector<ParameterFile>
  Study::planned_runs() const
  {
    std::vector<ParameterFile> result;
    for (const StudyValues &values : parameters.combinations())
      if (!parameters.seeks_limit())
        result.push_back(file_of(values));
      else
        for (const double value : {parameters.from, parameters.to})
          {
            StudyValues with = values;
            with.emplace_back(parameters.varied_to_limit, number_text(value));
            result.push_back(file_of(with));
          }
    return result;
  }


  ParameterFile
  Study::file_of(const StudyValues &values) const
  {
    std::vector<std::string> changes{"Study/Vary=",
                                     "Study/Spread over=",
                                     "Study/Limit/Entry=",
                                     "Output/Folder=" + folder_of(values)};
    for (const auto &[entry, value] : values)
      if (entry != strength_reduction)
        changes.push_back(entry + "=" + value);
    const ParameterFile changed = file.with(changes);
    changes.clear();
    for (const auto &[entry, value] : values)
      if (entry == strength_reduction)
        for (const std::string &strength : split_list(parameters.reduced, ';'))
          changes.push_back(
            strength + "=" +
            reduced_strength(strength, changed.given(strength), value));
    return changed.with(changes);
  }


  std::string
  Study::folder_of(const StudyValues &values) const
  {
    return folder + "/" + folder_name(values);
  }


  void
  Study::run()
  {
    const auto combinations = parameters.combinations();
    claim_folder();
    if (my_group == 0)
      report("Study of " +
             counted(combinations.size(), "combination", "combinations") +
             " in " + folder +
             (n_groups > 1 ? ", " + std::to_string(n_groups) + " side by side" :
                             std::string()));
    if (parameters.reduces_strengths() && my_group == 0)
      report("The " + strength_reduction + " divides " +
             join(split_list(parameters.reduced, ';'), "; ") +
             (strengths_kept.empty() ?
                std::string(", all strengths that there are") :
                "\nIt leaves as they are " + join(strengths_kept, "; ")));
    for (std::size_t i = my_group; i < combinations.size(); i += n_groups)
      if (parameters.seeks_limit())
        seek_limit(combinations[i]);
      else
        outcome_of(combinations[i]);
    gather();
    write_tables();
    conclude();
  }


  void
  Study::claim_folder()
  {
    bool mine = true;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        std::error_code problem;
        fs::create_directories(folder, problem);
        mine = lock.take(folder + "/.lock");
      }
    if (!Utilities::MPI::broadcast(communicator, mine))
      throw UserError("The folder \"" + folder +
                      "\" is that of a study which is still going on; wait for "
                      "its end, or choose another \"Folder\" in section "
                      "\"Output\".");
  }


  void
  Study::conclude() const
  {
    const auto number_of = [this](const RunEnd end) {
      return std::count_if(outcomes.begin(),
                           outcomes.end(),
                           [end](const Outcome &run) {
                             return run.summary.end == end;
                           });
    };
    const auto n_failed  = number_of(RunEnd::failed),
               n_stopped = number_of(RunEnd::stopped),
               n_stand = std::ptrdiff_t(outcomes.size()) - n_failed - n_stopped;
    const std::string count =
      "Of " + counted(outcomes.size(), "run", "runs") + " in \"" + folder +
      "\" " + std::to_string(n_stand) +
      (n_stand == 1 ? " stands, " : " stand, ") + std::to_string(n_stopped) +
      (n_stopped == 1 ? " was stopped, " : " were stopped, ") +
      std::to_string(n_failed) + " failed";
    if (n_stand == 0)
      throw UserError("None of the runs of the study came to its end; the "
                      "first one " +
                      verdict_of(outcomes.at(0).summary) + ". " + count + ".");
    if (n_failed > 0)
      throw IncompleteStudy(count +
                            "; mend what the verdicts in study.csv name and "
                            "start the study again, which does only the runs "
                            "that failed.");
    // a search for a limit goes on from a run that was stopped only if that one
    // has met the criterion
    if (n_stopped > 0 && !parameters.seeks_limit())
      throw IncompleteStudy(count + "; the verdicts in study.csv say why.");
    if (my_group == 0)
      report(count);
  }


  std::size_t
  Study::n_expected() const
  {
    const auto        n     = parameters.combinations().size();
    const std::size_t mine  = n / n_groups + (my_group < n % n_groups);
    const double      width = parameters.to - parameters.from;
    return parameters.seeks_limit() ?
             mine * static_cast<std::size_t>(
                      2 + std::max(0.,
                                   std::ceil(
                                     std::log2(width / parameters.accuracy)))) :
             mine;
  }


  const Study::Outcome &
  Study::outcome_of(const StudyValues &values)
  {
    for (const Outcome &outcome : outcomes)
      if (outcome.values == values)
        return outcome;

    const std::string run_folder = folder_of(values),
                      record     = run_folder + ".json";
    Case                 run(file_of(values));
    const nlohmann::json identity = result_identity_of(run);
    // of no interest where all is done anew
    const nlohmann::json known =
      options.overwrite ? nlohmann::json() : read_record(record, group);
    const bool has_ended = known.is_object() && known.contains("summary");
    RunSummary summary;
    if (has_ended)
      known.at("summary").get_to(summary);
    const bool has_been_done = has_ended && summary.end != RunEnd::failed;
    // entries of a run that failed may have been mended
    if (known.is_object() && (has_been_done || !has_ended))
      check_same(known.at("identity"), identity, run_folder);
    const Timer clock_of_run;
    if (has_been_done)
      report(description(values) + ": taken, " + verdict_of(summary));
    else
      {
        const auto write = [&](const nlohmann::json &text) {
          if (Utilities::MPI::this_mpi_process(group) > 0)
            return;
          if (const std::string reason =
                write_file(record, text.dump(2) + '\n');
              !reason.empty())
            throw UserError("\"" + record + "\" cannot be written because " +
                            reason + ".");
        };
        write({{"identity", identity}});
        // what failed has nothing to go on from
        summary = do_run(run, run_folder, known.is_object() && !has_ended);
        write({{"identity", identity}, {"summary", summary}});
        ++n_done;
        seconds_of_runs += clock_of_run.wall_time();
        const std::size_t expected = n_expected(), ended = outcomes.size() + 1;
        report(description(values) + ": " + summary.verdict() + ", " +
               duration_text(clock_of_run.wall_time()) +
               (ended < expected ? ", about " +
                                     duration_text(double(expected - ended) *
                                                   seconds_of_runs / n_done) +
                                     " left" :
                                   std::string()));
      }
    outcomes.emplace_back(values, run_folder, summary);
    return outcomes.back();
  }


  RunSummary
  Study::do_run(const Case        &run,
                const std::string &run_folder,
                const bool         may_go_on) const
  {
    RunOptions how = options;
    how.quiet      = true;
    how.overwrite  = true;
    std::vector<std::string> damaged;
    how.restart =
      may_go_on &&
      !Checkpoint(run_folder + "/checkpoint", group).newest(damaged).empty();
    RunSummary summary;
    try
      {
        summary = Simulation(run, how, group).run.march();
      }
    catch (const StoppedRun &stopped)
      {
        summary = stopped.summary;
      }
    catch (const RunStopped &stopped)
      {
        summary.end    = RunEnd::stopped;
        summary.reason = stopped.what();
      }
    catch (const UserError &error)
      {
        summary.end    = RunEnd::failed;
        summary.reason = error.what();
      }
    // what the first rank knows
    return nlohmann::json::parse(
      Utilities::MPI::broadcast(group, nlohmann::json(summary).dump()));
  }


  bool
  Study::is_met(StudyValues values, const double value)
  {
    values.emplace_back(parameters.varied_to_limit, number_text(value));
    const Outcome     outcome = outcome_of(values);
    const RunSummary &summary = outcome.summary;
    const std::string where =
      "At " + parameters.varied_to_limit + " = " + number_text(value) + " ";
    if (summary.end == RunEnd::failed)
      throw UserError(where + "the run in \"" + outcome.folder + "\" " +
                      verdict_of(summary) +
                      ", which says nothing about the criterion of section "
                      "\"Study/Limit\"; mend that and start the study again.");
    for (const Criterion &criterion : parameters.criteria())
      {
        const auto [number, met] = criterion.evaluate(summary);
        if (met)
          {
            report(
              "  met: " + criterion.text +
              (number ? " (" + number_text(*number) + ")" : std::string()));
            return true;
          }
      }
    if (summary.end == RunEnd::stopped)
      throw UserError(
        where + "the run in \"" + outcome.folder + "\" was " +
        verdict_of(summary) +
        ", before the criterion of section \"Study/Limit\" was met; whether it "
        "would have been nobody knows: add \"; stopped\" to it if that "
        "counts as failure.");
    return false;
  }


  void
  Study::seek_limit(const StudyValues &values)
  {
    constexpr unsigned int max_extensions = 4;
    const double           span           = parameters.to - parameters.from;
    Limit                  limit{values, parameters.from, parameters.to};
    const auto             refuse = [&](const double value, const char *how) {
      throw UserError(
        "At " + parameters.varied_to_limit + " = " + number_text(value) +
        " the criterion of section "
                    "\"Study/Limit\" is " +
        how + "; give another \"From\" or \"To\"" +
        (parameters.extend ? "." : ", or set \"Extend = true\"."));
    };
    for (unsigned int i = 0; is_met(values, limit.fails); ++i)
      {
        if (!parameters.extend || i == max_extensions)
          refuse(limit.fails, "met already");
        limit.meets = limit.fails;
        // a factor does not become negative
        limit.fails =
          limit.fails > span ? limit.fails - span : 0.5 * limit.fails;
      }
    for (unsigned int i = 0;
         limit.fails >= parameters.from && limit.meets >= parameters.to &&
         !is_met(values, limit.meets);
         ++i)
      {
        if (!parameters.extend || i == max_extensions)
          refuse(limit.meets, "not met yet");
        limit.fails = limit.meets;
        limit.meets += span;
      }
    while (limit.meets - limit.fails > parameters.accuracy * (1. + 1e-9))
      {
        const double middle = 0.5 * (limit.fails + limit.meets);
        (is_met(values, middle) ? limit.meets : limit.fails) = middle;
      }
    report((values.empty() ? std::string() : description(values) + ": ") +
           "limit of " + parameters.varied_to_limit + " between " +
           number_text(limit.fails) + " and " + number_text(limit.meets));
    limits.push_back(limit);
  }


  void
  Study::report(const std::string &text) const
  {
    if (!options.quiet && Utilities::MPI::this_mpi_process(group) == 0)
      std::cout << text << std::endl;
  }


  void
  Study::gather()
  {
    nlohmann::json mine{{"outcomes", nlohmann::json::array()},
                        {"limits", nlohmann::json::array()}};
    if (Utilities::MPI::this_mpi_process(group) == 0)
      {
        for (const Outcome &outcome : outcomes)
          mine["outcomes"].push_back(
            {outcome.values, outcome.folder, outcome.summary});
        for (const Limit &limit : limits)
          mine["limits"].push_back({limit.values, limit.fails, limit.meets});
      }
    outcomes.clear();
    limits.clear();
    for (const std::string &part :
         Utilities::MPI::all_gather(communicator, mine.dump()))
      {
        const nlohmann::json theirs = nlohmann::json::parse(part);
        for (const nlohmann::json &outcome : theirs.at("outcomes"))
          outcomes.emplace_back(outcome.at(0).get<StudyValues>(),
                                outcome.at(1).get<std::string>(),
                                outcome.at(2).get<RunSummary>());
        for (const nlohmann::json &limit : theirs.at("limits"))
          limits.push_back({limit.at(0), limit.at(1), limit.at(2)});
      }
    // runs of a search come in the order of its steps
    if (parameters.seeks_limit())
      std::stable_sort(outcomes.begin(),
                       outcomes.end(),
                       [](const Outcome &a, const Outcome &b) {
                         return comes_before(a.values, b.values);
                       });
  }


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
    for (const auto &[name, text] : files)
      if (const std::string reason = write_file(folder + name, text);
          !reason.empty())
        throw UserError("\"" + folder + name + "\" cannot be written because " +
                        reason + ".");
    report("The study is in " + folder + "/study.csv and study.json");
  }


  // Of the limits, if they are sought, and of the runs otherwise.
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
            // what failed is not beyond the others
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
    for (const auto &item : outcomes.at(0).values)
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
        for (const auto &item : outcome.values)
          line.push_back(item.second);
        for (const SummaryNumber *number : columns)
          {
            const std::optional<double> value = number->in(outcome.numbers);
            line.push_back(value ? number_text(*value) : "");
          }
        if (parameters.seeks_limit())
          line.push_back(met_criteria(parameters.criteria(), outcome.summary));
        line.push_back(verdict_of(outcome.summary));
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
                           {"values", as_object(outcome.values)}};
        for (const SummaryNumber &number : parameters.numbers())
          if (const std::optional<double> value = number.in(outcome.numbers))
            run["quantities"][number.path] = *value;
        if (parameters.seeks_limit())
          if (const std::string met =
                met_criteria(parameters.criteria(), outcome.summary);
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
    return all;
  }
} // namespace Voussoir
