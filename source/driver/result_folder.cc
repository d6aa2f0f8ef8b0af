#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/case_identity.h>
#include <voussoir/driver/result_folder.h>
#include <voussoir/output/checkpoint.h>

#include <filesystem>

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    /** The folder that the case names and those with a number added, the newest
     *  first. */
    std::vector<std::string>
    earlier_folders(const std::string &wanted, const MPI_Comm communicator)
    {
      std::vector<std::string> folders;
      std::string              next = wanted;
      if (Utilities::MPI::this_mpi_process(communicator) == 0)
        for (unsigned int n = 2; fs::exists(next); ++n)
          {
            folders.insert(folders.begin(), next);
            next = wanted + "-" + std::to_string(n);
          }
      return Utilities::MPI::broadcast(communicator, folders);
    }


    std::string
    wanted_folder(const Case &parameters)
    {
      return parameters.output.folder.empty() ?
               "output/" + parameters.file.name() :
               parameters.output.folder;
    }


    std::string
    new_folder(const Case       &parameters,
               const RunOptions &options,
               const MPI_Comm    communicator)
    {
      const std::string wanted = wanted_folder(parameters);
      if (options.overwrite)
        {
          if (fs::exists(wanted) && !fs::exists(wanted + "/parameters.prm"))
            throw UserError("--overwrite does not remove \"" + wanted +
                            "\", which holds no parameters.prm of an earlier "
                            "run; choose another \"Folder\" in section "
                            "\"Output\".");
          return wanted;
        }
      const std::size_t n = earlier_folders(wanted, communicator).size();
      return n == 0 ? wanted : wanted + "-" + std::to_string(n + 1);
    }
  } // namespace


  ResultFolder::ResultFolder(const Case       &parameters,
                             const RunOptions &options,
                             Log              &log)
    : parameters(parameters)
    , options(options)
  {
    if (options.no_output)
      return;
    if (options.restart)
      find_checkpoint(log);
    else
      chosen = new_folder(parameters, options, log.communicator());
    log.line("Results go to ", chosen);
  }


  void
  ResultFolder::find_checkpoint(Log &log)
  {
    const std::string        wanted = wanted_folder(parameters);
    std::vector<std::string> damaged;
    for (const std::string &folder :
         earlier_folders(wanted, log.communicator()))
      {
        chosen = folder;
        from   = Checkpoint(checkpoints(), log.communicator()).newest(damaged);
        if (!from.empty())
          break;
      }
    if (from.empty())
      throw UserError(
        "There is no checkpoint in \"" + wanted + "\" to restart from" +
        (damaged.empty() ? "" : " (" + join(damaged, "; ") + ")") +
        "; run the case without --restart.");
    for (const std::string &file : damaged)
      log.line("Not used: the checkpoint ", file);
    header = read_state_header(from, log.communicator());
    check_identity(parameters, header.at("identity"), from);
    const double reached = header.at("time");
    if (reached < parameters.time.end_time)
      return;
    std::ostringstream text;
    text << "The checkpoint \"" << from << "\" is of " << reached
         << " s, but \"End time\" in section \"Time\" is "
         << parameters.time.end_time << " s; set a later one.";
    throw UserError(text.str());
  }


  void
  ResultFolder::make(Log &log) const
  {
    const bool first =
      Utilities::MPI::this_mpi_process(log.communicator()) == 0;
    std::error_code problem;
    if (first)
      {
        if (options.overwrite && !options.restart)
          fs::remove_all(chosen, problem);
        if (!problem)
          fs::create_directories(chosen, problem);
      }
    if (Utilities::MPI::max(problem ? 1 : 0, log.communicator()) == 1)
      throw UserError("The output folder \"" + chosen +
                      "\" cannot be made; choose another \"Folder\" in "
                      "section \"Output\".");
    log.open(chosen + "/log.txt", options.restart);
    if (first)
      {
        std::ofstream prm(chosen + "/parameters.prm");
        parameters.prm.print_parameters(prm, ParameterHandler::Text);
      }
  }


  std::string
  ResultFolder::path() const
  {
    return chosen;
  }


  bool
  ResultFolder::exists() const
  {
    return !chosen.empty();
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


  const nlohmann::json &
  ResultFolder::checkpoint() const
  {
    return header;
  }


  const std::string &
  ResultFolder::checkpoint_file() const
  {
    return from;
  }


  double
  ResultFolder::start_time() const
  {
    return restarts() ? header.at("time").get<double>() : 0.;
  }
} // namespace Voussoir
