#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/result_folder.h>
#include <voussoir/output/checkpoint.h>

#include <unistd.h>

#include <cerrno>
#include <climits>
#include <filesystem>

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    /** What the first rank does for all: they throw what it throws. */
    template <typename Action>
    void
    on_first_rank(const MPI_Comm communicator, const Action &action)
    {
      std::string problem;
      if (Utilities::MPI::this_mpi_process(communicator) == 0)
        try
          {
            action();
          }
        catch (const UserError &error)
          {
            problem = error.what();
          }
      problem = Utilities::MPI::broadcast(communicator, problem);
      if (!problem.empty())
        throw UserError(problem);
    }


    [[noreturn]] void
    refuse(const std::string &folder, const std::string &why)
    {
      throw UserError("The output folder \"" + folder + "\" " + why +
                      "; choose another \"Folder\" in section \"Output\".");
    }


    constexpr const char *still_going_on =
      "is that of a run which is still going on";


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


    std::string
    name_in(const Case &parameters)
    {
      std::string name = parameters.output.folder.empty() ?
                           "output/" + parameters.file.name() :
                           parameters.output.folder;
      while (name.size() > 1 && name.back() == '/')
        name.pop_back();
      return name;
    }


    /** Why nothing can be written to a folder, there or to be made, as far as
     *  that shows without trying; empty: it can. */
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


    std::string
    choose_folder(const Case &parameters, const RunOptions &options)
    {
      const std::string name = name_in(parameters);
      unsigned int      n    = 1;
      if (options.restart || !options.overwrite)
        while (is_there(numbered(name, n)))
          ++n;
      if (options.restart && n > 1)
        --n;
      const std::string folder = numbered(name, n);
      if (options.restart && !Checkpoint::exists(folder + "/checkpoint"))
        throw UserError("There is no checkpoint in \"" + folder +
                        "\" to restart from; run the case without "
                        "--restart.");
      if (const std::string reason = obstacle(folder); !reason.empty())
        refuse(folder, "cannot be written to because " + reason);
      if (options.overwrite && !options.restart && is_there(folder) &&
          !is_there(folder + "/parameters.prm"))
        throw UserError("--overwrite does not remove \"" + folder +
                        "\", which holds no parameters.prm of an earlier "
                        "run; choose another \"Folder\" in section "
                        "\"Output\".");
      return folder;
    }


    /** Makes a folder, and those that it is in; returns whether it was not
     *  there before. */
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
             kind == ".pvd" ||
             (kind == ".txt" &&
              is_there(fs::path(file).replace_extension("pvd")));
    }


    /** Removes what a run has written to its folder, and nothing else, such as
     *  the folder of another run there. */
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
  } // namespace


  ResultFolder::ResultFolder(const Case       &parameters,
                             const RunOptions &options,
                             Log              &log)
    : parameters(parameters)
    , options(options)
  {
    if (!wanted())
      return;
    on_first_rank(log.communicator(),
                  [&] { chosen = choose_folder(parameters, options); });
    chosen = Utilities::MPI::broadcast(log.communicator(), chosen);
    if (restarts())
      {
        header = Checkpoint::read_header(chosen + "/checkpoint");
        check_checkpoint();
      }
    on_first_rank(log.communicator(), [&] {
      if (FileLock::is_taken(lock_in(chosen)))
        refuse(chosen, still_going_on);
    });
  }


  void
  ResultFolder::claim(Log &log)
  {
    on_first_rank(log.communicator(), [&] {
      bool made = make_folder(chosen);
      if (!made && !options.restart && !options.overwrite)
        for (unsigned int n = 2; !made; ++n) // another run was faster
          {
            chosen = numbered(name_in(parameters), n);
            made   = make_folder(chosen);
          }
      if (!lock.take(lock_in(chosen)))
        refuse(chosen, still_going_on);
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


  nlohmann::json
  ResultFolder::physics() const
  {
    const std::set<std::string> free{"Title",
                                     "Mesh/Partition",
                                     "Time/End time"};
    std::ostringstream          text;
    parameters.prm.print_parameters(text, ParameterHandler::ShortText);
    nlohmann::json           result = nlohmann::json::array();
    std::istringstream       in(text.str());
    std::vector<std::string> sections;
    for (std::string line; std::getline(in, line);)
      {
        line              = Utilities::trim(line);
        const auto equals = line.find('=');
        if (line.rfind("subsection ", 0) == 0)
          sections.push_back(line.substr(11) + "/");
        else if (line == "end")
          sections.pop_back();
        else if (line.rfind("set ", 0) == 0)
          {
            const std::string entry =
              join(sections, "") + Utilities::trim(line.substr(4, equals - 4));
            if (free.count(entry) == 0 && entry.rfind("Output/", 0) != 0)
              result.push_back(entry + " =" + line.substr(equals + 1));
          }
      }
    return result;
  }


  void
  ResultFolder::check_checkpoint() const
  {
    const nlohmann::json mine = physics(), theirs = header.at("physics");
    const auto           line = [](const nlohmann::json &lines, std::size_t i) {
      return i < lines.size() ? Utilities::trim(lines[i].get<std::string>()) :
                                          std::string("nothing");
    };
    for (std::size_t i = 0; i < std::max(mine.size(), theirs.size()); ++i)
      if (line(mine, i) != line(theirs, i))
        throw UserError("The checkpoint in \"" + chosen +
                        "\" was written with \"" + line(theirs, i) +
                        "\", the case now has \"" + line(mine, i) +
                        "\"; restart with the same physics, or start "
                        "afresh.");
    const double reached = header.at("time");
    if (reached >= parameters.time.end_time)
      {
        std::ostringstream text;
        text << "The checkpoint in \"" << chosen << "\" is of " << reached
             << " s, but \"End time\" in section \"Time\" is "
             << parameters.time.end_time << " s; set a later one.";
        throw UserError(text.str());
      }
  }
} // namespace Voussoir
