#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/case_identity.h>
#include <voussoir/driver/random_classes.h>
#include <voussoir/driver/strength_reduction.h>
#include <voussoir/driver/study.h>

#include <filesystem>
#include <iostream>

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    /** A text without characters that folder names cannot have, and cut to
     *  their largest length; a checksum tells apart what is then alike, as
     *  "t*2" and "t^2". */
    std::string
    folder_name(const std::string &text)
    {
      constexpr std::size_t longest = 150;
      const std::string     without_sense("-_ =/'");
      bool                  is_alone = true;
      std::string           name;
      for (const char letter : text)
        if (std::isalnum(static_cast<unsigned char>(letter)) || letter == '.' ||
            letter == '+' || letter == '-')
          name += letter;
        else if (letter == ',')
          name += '_';
        else
          {
            is_alone =
              is_alone && without_sense.find(letter) != std::string::npos;
            if (!name.empty() && name.back() != '-' && name.back() != '_')
              name += '-';
          }
      if (name.size() > longest || !is_alone)
        name = name.substr(0, longest) + "-" + checksum(text);
      return name.empty() ? "run" : name;
    }
  } // namespace


  Study::Study(const ParameterFile &file,
               const RunOptions    &options,
               const MPI_Comm       communicator)
    : file(file)
    , options(options)
    , communicator(communicator)
  {
    const Case whole(without_random_fields(file));
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
    if (parameters.moves_numbers())
      plan_moves(whole);
    else
      combinations = parameters.combinations();
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
    for (const StudyValues &values : combinations)
      if (parameters.calibrates())
        result.push_back(file_of(fitted_values(
          values, dealii::Vector<double>(parameters.fitted_entries().size()))));
      else if (!parameters.seeks_limit())
        result.push_back(file_of(values));
      else
        for (const double value : {parameters.from, parameters.to})
          {
            StudyValues with = values;
            with.emplace_back(parameters.varied_to_limit,
                              number_text(value, fine_digits));
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
                                     "Study/Extrapolation/Over=",
                                     "Study/Fragility/Intensity=",
                                     "Study/Sensitivity/Change=0",
                                     "Study/Calibration/Fitted=",
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
    // several sections may have entries of the same name and value
    const bool whole_path = parameters.moves_numbers() && !values.empty();
    return folder + "/" +
           folder_name(whole_path ? values[0].first + " = " + values[0].second :
                                    description(values));
  }


  StudyValues
  Study::shown(const StudyValues &values) const
  {
    if (!parameters.moves_numbers())
      return values;
    if (values.empty())
      return {{"entry", "none"}, {"value", "as given"}};
    return {{"entry", values[0].first}, {"value", values[0].second}};
  }


  void
  Study::plan_moves(const Case &whole)
  {
    combinations.assign(1, {});
    for (const MovedNumber &number : moved_numbers(file, whole.prm, parameters))
      try
        {
          const StudyValues values{{number.entry, number.text}};
          Case              checked(file_of(values));
          moves.push_back(number);
          combinations.push_back(values);
        }
      catch (const UserError &error)
        {
          refused_moves.push_back(number.entry + " = " + number.text + ": " +
                                  error.what());
        }
    if (moves.empty())
      throw UserError("\"Entries\" in section \"Study/Sensitivity\" is \"" +
                      parameters.moved +
                      "\", but the file gives no such number that can be "
                      "moved; name others, as \"Materials/*\".");
  }


  void
  Study::introduce() const
  {
    if (my_group > 0)
      return;
    report("Study of " +
           (parameters.moves_numbers() ?
              counted(combinations.size(), "run", "runs") +
                ", one as the case is given and " +
                counted(moves.size(), "move", "moves") + " of a number by " +
                number_text(100. * parameters.change) + " %," :
              counted(combinations.size(), "combination", "combinations")) +
           " in " + folder +
           (n_groups > 1 ? ", " + std::to_string(n_groups) + " side by side" :
                           std::string()));
    if (!refused_moves.empty())
      report("Left out, as the program refuses them:\n  " +
             join(refused_moves, "\n  "));
    if (parameters.reduces_strengths())
      report("The " + strength_reduction + " divides " +
             join(split_list(parameters.reduced, ';'), "; ") +
             (strengths_kept.empty() ?
                std::string(", all strengths that there are") :
                "\nIt leaves unchanged " + join(strengths_kept, "; ")));
  }


  void
  Study::run()
  {
    claim_folder();
    introduce();
    for (std::size_t i = my_group; i < combinations.size(); i += n_groups)
      if (parameters.seeks_limit())
        seek_limit(combinations[i]);
      else if (parameters.calibrates())
        calibrate(combinations[i]);
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
      (n_stand == 1 ? " is complete, " : " are complete, ") +
      std::to_string(n_stopped) +
      (n_stopped == 1 ? " was stopped, " : " were stopped, ") +
      std::to_string(n_failed) + " failed";
    if (n_stand == 0)
      throw UserError("None of the runs of the study came to its end; the "
                      "first one " +
                      outcomes.at(0).summary.short_verdict() + ". " + count +
                      ".");
    if (n_failed > 0)
      throw IncompleteStudy(count +
                            "; correct the mistakes that the verdicts in "
                            "study.csv name and start the study again, which "
                            "does only the runs that failed.");
    // a search for a limit continues after a stopped run only if that run has
    // met the criterion
    if (n_stopped > 0 && !parameters.seeks_limit())
      throw IncompleteStudy(count +
                            "; the verdicts in study.csv give the reasons.");
    if (my_group == 0)
      report(count);
  }


  void
  Study::report(const std::string &text) const
  {
    if (!options.quiet && Utilities::MPI::this_mpi_process(group) == 0)
      std::cout << text << std::endl;
  }
} // namespace Voussoir
