#include <voussoir/base/error.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/case_identity.h>
#include <voussoir/driver/simulation.h>
#include <voussoir/driver/study.h>
#include <voussoir/output/checkpoint.h>

#include <cmath>
#include <fstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Contents of a file on the first rank; empty if there is no file. */
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


    /** Record of a study on a run: "identity" and, once the run has ended,
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
                      "\" is no record of a run by a study, or was changed; "
                      "remove it, and the study does this run again.");
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
                        "program, which did not record its entries" +
                        remedy);
      if (const auto difference = first_difference(recorded, now))
        throw UserError("The run in \"" + run_folder +
                        "\" has been done with \"" + difference->first +
                        "\", the study now has \"" + difference->second + "\"" +
                        remedy);
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
  } // namespace


  Study::Outcome::Outcome(const StudyValues &values,
                          const std::string &folder,
                          const RunSummary  &summary)
    : values(values)
    , folder(folder)
    , summary(summary)
    , numbers(summary)
  {}


  std::size_t
  Study::n_expected() const
  {
    const auto        n     = combinations.size();
    const std::size_t mine  = n / n_groups + (my_group < n % n_groups);
    const double      width = parameters.to - parameters.from;
    if (parameters.calibrates()) // three steps or so
      return mine * (1 + 3 * (1 + parameters.fitted_entries().size()));
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
    // not read where all runs are done anew
    const nlohmann::json known =
      options.overwrite ? nlohmann::json() : read_record(record, group);
    const bool has_ended = known.is_object() && known.contains("summary");
    RunSummary summary;
    if (has_ended)
      known.at("summary").get_to(summary);
    const bool has_been_done = has_ended && summary.end != RunEnd::failed;
    // entries of a failed run may have been corrected
    if (known.is_object() && (has_been_done || !has_ended))
      check_same(known.at("identity"), identity, run_folder);
    const Timer clock_of_run;
    if (has_been_done)
      report(description(shown(values)) + ": taken, " +
             summary.short_verdict());
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
        // a failed run has no state to continue from
        summary = do_run(run, run_folder, known.is_object() && !has_ended);
        write({{"identity", identity}, {"summary", summary}});
        ++n_done;
        seconds_of_runs += clock_of_run.wall_time();
        const std::size_t expected = n_expected(), ended = outcomes.size() + 1;
        report(description(shown(values)) + ": " + summary.verdict() + ", " +
               duration_text(clock_of_run.wall_time()) +
               (ended < expected ? ", about " +
                                     duration_text(double(expected - ended) *
                                                   seconds_of_runs / n_done) +
                                     " left" :
                                   std::string()));
      }
    outcomes.emplace_back(values, run_folder, summary);
    // a misspelt path shows after the first run, not after the last one
    if (summary.end == RunEnd::complete)
      check_numbers(parameters.named_numbers(), summary);
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
    // the results are on the first rank
    return nlohmann::json::parse(
      Utilities::MPI::broadcast(group, nlohmann::json(summary).dump()));
  }


  void
  Study::gather()
  {
    nlohmann::json mine{{"outcomes", nlohmann::json::array()},
                        {"limits", nlohmann::json::array()},
                        {"calibrations", nlohmann::json::array()}};
    if (Utilities::MPI::this_mpi_process(group) == 0)
      {
        for (const Outcome &outcome : outcomes)
          mine["outcomes"].push_back(
            {outcome.values, outcome.folder, outcome.summary});
        for (const Limit &limit : limits)
          mine["limits"].push_back({limit.values, limit.fails, limit.meets});
        // as text, to keep the order of the columns
        for (const nlohmann::ordered_json &line : calibrations)
          mine["calibrations"].push_back(line.dump());
      }
    outcomes.clear();
    limits.clear();
    calibrations.clear();
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
        for (const std::string line : theirs.at("calibrations"))
          calibrations.push_back(nlohmann::ordered_json::parse(line));
      }
    // runs of a search come in the order of its steps
    if (parameters.seeks_limit())
      std::stable_sort(outcomes.begin(),
                       outcomes.end(),
                       [](const Outcome &a, const Outcome &b) {
                         return comes_before(a.values, b.values);
                       });
  }
} // namespace Voussoir
