#include <voussoir/base/first_rank.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/case_identity.h>
#include <voussoir/driver/result_folder.h>
#include <voussoir/driver/run_summary.h>
#include <voussoir/files/tension_file.h>
#include <voussoir/output/checkpoint.h>

#include <unistd.h>

#include <cerrno>
#include <climits>
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  std::string
  name_of_results(const Case &parameters)
  {
    std::string name = parameters.output.folder.empty() ?
                         "output/" + parameters.file.name() :
                         parameters.output.folder;
    while (name.size() > 1 && name.back() == '/')
      name.pop_back();
    return name;
  }


  namespace
  {
    [[noreturn]] void
    refuse(const std::string &folder, const std::string &why)
    {
      throw UserError("The output folder \"" + folder + "\" " + why +
                      "; choose another \"Folder\" in section \"Output\".");
    }


    constexpr const char *still_going_on =
      "belongs to a run that is still going on";


    std::string
    lock_in(const std::string &folder)
    {
      return folder + "/.lock";
    }


    bool
    is_there(const fs::path &file)
    {
      std::error_code ignored;
      return fs::exists(file, ignored);
    }


    /** The n-th folder of this name. */
    std::string
    numbered(const std::string &name, const unsigned int n)
    {
      return n == 1 ? name : name + "-" + std::to_string(n);
    }


    /** Reason why nothing can be written to a folder, existing or to be made,
     *  as far as known without an attempt; empty: writing is possible. */
    std::string
    obstacle(const fs::path &folder)
    {
      for (fs::path there = fs::absolute(folder);; there = there.parent_path())
        if (there.filename().string().size() > NAME_MAX)
          return reason_of(ENAMETOOLONG);
        else if (::access(there.c_str(), W_OK | X_OK) == 0)
          return fs::is_directory(there) ? "" : reason_of(ENOTDIR);
        else if (errno != ENOENT)
          return reason_of(errno);
    }


    /** Number of folders of this name. */
    unsigned int
    count(const std::string &name)
    {
      unsigned int n = 0;
      while (is_there(numbered(name, n + 1)))
        ++n;
      return n;
    }


    /** A run that has come to its end and left all files. */
    struct FinishedRun
    {
      double end  = std::numeric_limits<double>::quiet_NaN(); // [s]
      double step = end;

      bool
      has_ended() const
      {
        return !std::isnan(end);
      }

      bool
      reaches(const double time) const
      {
        return end > time - 0.5 * step;
      }
    };


    /** The finished run of a folder; without numbers if there is none. */
    FinishedRun
    finished_run(const std::string &folder)
    {
      std::ifstream        in(folder + "/summary.json");
      const nlohmann::json summary =
        nlohmann::json::parse(in, nullptr, /*allow_exceptions=*/false);
      if (!is_summary(summary) || summary.contains("files not written"))
        return {};
      const std::string verdict = summary.at("verdict");
      if (verdict.rfind("stopped", 0) == 0 || verdict.rfind("failed", 0) == 0)
        return {};
      FinishedRun run;
      const auto  read = [&summary](const char *name, double &value) {
        if (const auto found = summary.find(name);
            found != summary.end() && found->is_number())
          value = *found;
      };
      read("end time [s]", run.end);
      read("time step [s]", run.step);
      return run;
    }


    void
    check_writable(const std::string &folder)
    {
      if (const std::string reason = obstacle(folder); !reason.empty())
        refuse(folder, "cannot be written to because " + reason);
      if (FileLock::is_taken(lock_in(folder)))
        refuse(folder, still_going_on);
    }


    std::string
    new_folder(const Case &parameters, const RunOptions &options)
    {
      const std::string name = name_of_results(parameters);
      const std::string folder =
        numbered(name, options.overwrite ? 1 : count(name) + 1);
      check_writable(folder);
      if (options.overwrite && is_there(folder) &&
          !is_there(folder + "/parameters.prm"))
        throw UserError("--overwrite does not remove \"" + folder +
                        "\", which holds no parameters.prm of an earlier "
                        "run; choose another \"Folder\" in section "
                        "\"Output\".");
      return folder;
    }


    /** Makes a folder and its parent folders; returns whether it is new. */
    bool
    make_folder(const std::string &folder)
    {
      std::error_code problem;
      fs::create_directories(fs::absolute(folder).parent_path(), problem);
      const bool made = !problem && fs::create_directory(folder, problem);
      if (problem)
        refuse(folder, "cannot be made because " + reason_of(problem.value()));
      return made;
    }


    /** Whether a run writes files of this kind to its folder. */
    bool
    is_result(const fs::path &file)
    {
      const std::string name = file.filename(), kind = file.extension();
      return name == "log.txt" || name == "parameters.prm" ||
             name == "summary.json" || kind == ".csv" || kind == ".vtu" ||
             kind == ".pvd" || name == fs::path(tension_file("")).filename() ||
             (kind == ".txt" &&
              is_there(fs::path(file).replace_extension("pvd")));
    }


    /** Removes the files that a run has written to its folder, and nothing
     *  else, such as the folder of another run there. */
    void
    remove_results(const std::string &folder)
    {
      std::vector<fs::path> results{fs::path(folder) / "checkpoint"};
      for (const auto &entry : fs::directory_iterator(folder))
        if (!entry.is_directory() && is_result(entry))
          results.push_back(entry);
        else if (entry.is_directory())
          for (const auto &picture : fs::directory_iterator(entry))
            if (const std::string name = picture.path().filename();
                name.rfind(entry.path().filename().string() + "-", 0) == 0 &&
                is_result(picture))
              results.push_back(picture);
      for (const fs::path &result : results)
        fs::remove_all(result);
    }


    /** The same in the folder of a run and in those of its checkpoints and
     *  pictures. */
    void
    remove_unfinished_of_run(const std::string &folder)
    {
      remove_unfinished(folder);
      std::error_code problem;
      for (const auto &entry : fs::directory_iterator(folder, problem))
        if (entry.is_directory(problem) &&
            !is_there(entry.path() / "parameters.prm"))
          remove_unfinished(entry.path());
    }
  } // namespace


  void
  remove_unfinished(const std::string &folder, const std::string &start)
  {
    static const std::regex unfinished(
      R"(.+\.(csv|h5|json|prm|pvd|txt|vtu)\.(part|unfinished)(-\d+-\d+\.lock)?)");
    std::error_code       problem;
    std::vector<fs::path> files;
    for (const auto &entry : fs::directory_iterator(folder, problem))
      if (const std::string name = entry.path().filename();
          name.rfind(start, 0) == 0 && std::regex_match(name, unfinished))
        files.push_back(entry);
    for (const fs::path &file : files)
      fs::remove(file, problem);
  }


  ResultFolder::ResultFolder(const Case       &parameters,
                             const RunOptions &options,
                             Log              &log)
    : parameters(parameters)
    , options(options)
  {
    if (!wanted())
      return;
    if (options.restart)
      find_checkpoint(log);
    else
      {
        on_first_rank(log.communicator(),
                      [&] { chosen = new_folder(parameters, options); });
        chosen = Utilities::MPI::broadcast(log.communicator(), chosen);
      }
  }


  void
  ResultFolder::find_checkpoint(Log &log)
  {
    const std::string  name = name_of_results(parameters);
    const unsigned int n =
      Utilities::MPI::broadcast(log.communicator(), count(name));
    std::vector<std::string> damaged, finished;
    FinishedRun              run;
    for (unsigned int i = n; i > 0 && from.empty(); --i)
      {
        chosen = numbered(name, i);
        run =
          Utilities::MPI::broadcast(log.communicator(), finished_run(chosen));
        // A study may not have recorded a finished run, and restarts it. An
        // older run than the newest one is continued only if it was
        // interrupted.
        if (!options.overwrite && (run.reaches(parameters.time.end_time) ||
                                   (!finished.empty() && run.has_ended())))
          {
            finished.push_back(chosen);
            continue;
          }
        from = Checkpoint(checkpoints(), log.communicator()).newest(damaged);
      }
    if (from.empty() && !finished.empty())
      throw UserError(
        "The run in \"" + finished[0] +
        "\" has come to its end, so that there is nothing to go "
        "on with; set a later \"End time\" in section \"Time\", or "
        "run the case without --restart.");
    if (from.empty())
      throw UserError(
        "There is no checkpoint in \"" + numbered(name, std::max(n, 1u)) +
        "\" to restart from" +
        (damaged.empty() ? "" : " (" + join(damaged, "; ") + ")") +
        "; run the case without --restart.");
    for (const std::string &file : damaged)
      log.line("Not used: the checkpoint ", file);
    on_first_rank(log.communicator(), [&] { check_writable(chosen); });
    header = read_state_header(from, log.communicator());
    check_identity(parameters, header.at("identity"), from);
    on_first_rank(log.communicator(), [&] { check_sizes(); });
    const double reached = header.at("time");
    if (reached < parameters.time.end_time)
      {
        if (run.reaches(reached))
          log.line("The run in \"",
                   chosen,
                   "\" had come to its end at ",
                   run.end,
                   " s and is extended to ",
                   parameters.time.end_time,
                   " s, from its checkpoint of ",
                   reached,
                   " s");
        return;
      }
    std::ostringstream text;
    text << "The checkpoint \"" << from << "\" is of " << reached
         << " s, but \"End time\" in section \"Time\" is "
         << parameters.time.end_time << " s; set a later one.";
    throw UserError(text.str());
  }


  void
  ResultFolder::check_sizes() const
  {
    for (const auto &[name, size] : header.at("sizes of files").items())
      {
        if (size == 0) // no file yet, as of a list of pictures without any
          continue;
        const std::string file = chosen + "/" + name;
        std::error_code   problem;
        const auto        now = fs::file_size(file, problem);
        if (problem || now < size.get<std::uintmax_t>())
          throw UserError(
            "The file \"" + file + "\" " +
            (problem ? "is missing" : "has been cut off") +
            " since the checkpoint \"" + from +
            "\" was written; restore the file, or start the case anew.");
      }
  }


  void
  ResultFolder::claim(Log &log)
  {
    on_first_rank(log.communicator(), [&] {
      bool made = make_folder(chosen);
      if (!made && !options.restart && !options.overwrite)
        for (unsigned int n = 2; !made;
             ++n) // another run has claimed this folder first
          {
            chosen = numbered(name_of_results(parameters), n);
            made   = make_folder(chosen);
          }
      if (!lock.take(lock_in(chosen)))
        refuse(chosen, still_going_on);
      remove_unfinished_of_run(chosen);
      try
        {
          if (!made && !options.restart)
            remove_results(chosen);
        }
      catch (const fs::filesystem_error &error)
        {
          refuse(chosen,
                 "cannot be emptied: " + error.path1().string() + ", because " +
                   reason_of(error.code().value()));
        }
      std::ostringstream text;
      parameters.prm.print_parameters(text, ParameterHandler::Text);
      if (const std::string reason =
            write_file(chosen + "/parameters.prm", text.str());
          !reason.empty())
        {
          if (made)
            fs::remove_all(chosen);
          refuse(chosen, "cannot be written to because " + reason);
        }
    });
    chosen  = Utilities::MPI::broadcast(log.communicator(), chosen);
    claimed = true;
    log.line("Results go to ", chosen);
    log.open(chosen + "/log.txt", options.restart);
    log.attempted(chosen + "/parameters.prm", "");
  }


  bool
  ResultFolder::wanted() const
  {
    return !options.no_output;
  }


  bool
  ResultFolder::exists() const
  {
    return claimed;
  }


  std::string
  ResultFolder::path() const
  {
    return claimed ? chosen : "";
  }


  bool
  ResultFolder::restarts() const
  {
    return options.restart;
  }


  std::string
  ResultFolder::checkpoints() const
  {
    return chosen + "/checkpoint";
  }


  const std::string &
  ResultFolder::checkpoint_file() const
  {
    return from;
  }


  const nlohmann::json &
  ResultFolder::checkpoint() const
  {
    return header;
  }


  double
  ResultFolder::start_time() const
  {
    return restarts() ? header.at("time").get<double>() : 0.;
  }
} // namespace Voussoir
