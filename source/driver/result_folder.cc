#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/result_folder.h>
#include <voussoir/output/checkpoint.h>

#include <filesystem>

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    std::string
    choose_folder(const Case       &parameters,
                  const RunOptions &options,
                  const MPI_Comm    communicator)
    {
      if (options.no_output)
        return "";
      const std::string wanted = parameters.output.folder.empty() ?
                                   "output/" + parameters.file.name() :
                                   parameters.output.folder;
      if (options.overwrite && !options.restart)
        {
          if (fs::exists(wanted) && !fs::exists(wanted + "/parameters.prm"))
            throw UserError("--overwrite does not remove \"" + wanted +
                            "\", which holds no parameters.prm of an earlier "
                            "run; choose another \"Folder\" in section "
                            "\"Output\".");
          return wanted;
        }
      std::string next = wanted, last = wanted;
      if (Utilities::MPI::this_mpi_process(communicator) == 0)
        for (unsigned int n = 2; fs::exists(next); ++n)
          {
            last = next;
            next = wanted + "-" + std::to_string(n);
          }
      const std::string chosen =
        Utilities::MPI::broadcast(communicator, options.restart ? last : next);
      if (options.restart && !Checkpoint::exists(chosen + "/checkpoint"))
        throw UserError("There is no checkpoint in \"" + chosen +
                        "\" to restart from; run the case without "
                        "--restart.");
      return chosen;
    }
  } // namespace


  ResultFolder::ResultFolder(const Case       &parameters,
                             const RunOptions &options,
                             Log              &log)
    : parameters(parameters)
    , options(options)
    , chosen(choose_folder(parameters, options, log.communicator()))
  {
    if (exists())
      log.line("Results go to ", chosen);
    if (restarts())
      {
        header = Checkpoint::read_header(chosen + "/checkpoint");
        check_checkpoint();
      }
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
