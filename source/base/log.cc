#include <voussoir/base/log.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iomanip>

namespace Voussoir
{
  namespace
  {
    using namespace std::chrono_literals;
    constexpr auto bar_interval = 200ms, line_interval = 5000ms;

    const char *const waits_in_memory =
      "; missing text waits in memory until it can be written";

    /** Whether messages go to a terminal that can overwrite a line. */
    bool
    is_watched()
    {
      const char *terminal = std::getenv("TERM");
      if (isatty(STDOUT_FILENO) == 0 || terminal == nullptr ||
          std::string(terminal) == "dumb")
        return false;
#if defined(OMPI_MAJOR_VERSION) && OMPI_MAJOR_VERSION >= 5
      // the mpirun of Open MPI passes on whole lines only
      if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr)
        return false;
#endif
      // mpirun gives each process a pseudo-terminal and forwards its output, so
      // the output of the parent process, mpirun, is checked
      std::error_code   none;
      const std::string output = std::filesystem::read_symlink(
        "/proc/" + std::to_string(getppid()) + "/fd/1", none);
      return output.rfind("/dev/pts/", 0) == 0 ||
             output.rfind("/dev/tty", 0) == 0;
    }
  } // namespace


  Log::Log(const MPI_Comm communicator, const bool quiet)
    : mpi_communicator(communicator)
    , speaks(dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    , quiet(quiet)
    , has_bar(speaks && !quiet && is_watched())
    , last_bar(Clock::now())
    , last_line(last_bar)
  {}


  Log::~Log()
  {
    if (shows_bar)
      show("");
  }


  void
  Log::open(const std::string &filename, const bool append)
  {
    missing.clear();
    sizes.clear();
    growing.clear();
    if (!speaks)
      return;
    std::error_code none;
    const auto      size = std::filesystem::file_size(filename, none);
    file.open(filename, append && !none ? size : 0);
    attempted(filename, file.flush());
  }


  void
  Log::operator()(const std::string &text)
  {
    if (!speaks)
      return;
    show(text);
    write(text);
    last_line = Clock::now();
  }


  void
  Log::show(const std::string &text)
  {
    if (quiet)
      return;
    // moves to the beginning of the line and clears it
    std::cout << (shows_bar ? "\r\033[K" : "") << text << std::flush;
    shows_bar = false;
  }


  void
  Log::write(const std::string &text)
  {
    file.append(text);
    if (!file.name().empty())
      attempted(file.name(), file.flush());
  }


  bool
  Log::progress_is_due() const
  {
    const auto now = Clock::now();
    return speaks && (now - last_line > line_interval ||
                      (has_bar && now - last_bar > bar_interval));
  }


  void
  Log::progress(const double share_done, const std::string &text)
  {
    if (!progress_is_due())
      return;
    constexpr std::size_t length = 20;
    std::ostringstream    line;
    line << std::fixed << std::setprecision(1) << std::setw(5)
         << 100. * share_done << " %  " << text;
    last_bar = Clock::now();
    if (has_bar)
      {
        const auto full =
          std::min<std::size_t>(std::lround(length * share_done), length);
        // a line too long for the terminal is cut off instead of wrapped
        show("\033[?7l[" + std::string(full, '#') +
             std::string(length - full, '-') + "] " + line.str() + "\033[?7h");
        shows_bar = true;
      }
    if (last_bar - last_line < line_interval)
      return;
    last_line = last_bar;
    line << '\n';
    if (!has_bar)
      show(line.str());
    write(line.str());
  }


  void
  Log::add_warning(const std::string &text)
  {
    if (std::find(all_warnings.begin(), all_warnings.end(), text) !=
        all_warnings.end())
      return;
    all_warnings.push_back(text);
    line("Warning: ", text);
  }


  const std::vector<std::string> &
  Log::warnings() const
  {
    return all_warnings;
  }


  void
  Log::attempted(const std::string &file,
                 const std::string &reason,
                 const std::string &remark)
  {
    if (!speaks)
      return;
    if (!reason.empty())
      {
        missing[file] = reason;
        warn('"', file, "\" cannot be written because ", reason, remark);
      }
    else
      {
        std::error_code none;
        if (std::filesystem::is_regular_file(file, none))
          sizes[file] = std::filesystem::file_size(file, none);
        if (missing.erase(file) > 0)
          line("All of \"", file, "\" is written now.");
      }
  }


  std::shared_ptr<GrowingFile>
  Log::grow(const std::string &filename, const std::uintmax_t keep)
  {
    auto result = std::make_shared<GrowingFile>();
    if (!speaks)
      return result;
    result->open(filename, keep);
    growing.push_back(result);
    return result;
  }


  bool
  Log::write_growing_files()
  {
    bool all_written = true;
    for (const auto &one : growing)
      if (const auto grown = one.lock())
        {
          write(*grown);
          all_written = all_written && !grown->has_waiting();
        }
    return dealii::Utilities::MPI::broadcast(mpi_communicator, all_written);
  }


  void
  Log::write(GrowingFile &grown)
  {
    if (speaks)
      attempted(grown.name(), grown.flush(), waits_in_memory);
  }


  std::map<std::string, std::uint64_t>
  Log::sizes_of_growing_files() const
  {
    std::map<std::string, std::uint64_t> result;
    for (const auto &one : growing)
      if (const auto grown = one.lock())
        result[grown->name()] = grown->size();
    return dealii::Utilities::MPI::broadcast(mpi_communicator, result);
  }


  void
  Log::check_for_lost_files()
  {
    const auto written = sizes; // the warning below changes the size of log.txt
    for (const auto &[file, size] : written)
      {
        std::error_code problem;
        const auto      now = std::filesystem::file_size(file, problem);
        if (missing.count(file) == 0 &&
            (problem || (now != size && file != this->file.name())))
          attempted(file,
                    problem ? removed_meanwhile :
                              "it was changed while the run went on");
      }
  }


  std::map<std::string, std::string>
  Log::missing_files() const
  {
    return dealii::Utilities::MPI::broadcast(mpi_communicator, missing);
  }


  MPI_Comm
  Log::communicator() const
  {
    return mpi_communicator;
  }


  std::string
  duration_text(const double seconds)
  {
    const long         total = std::lround(seconds);
    std::ostringstream text;
    text << std::setfill('0');
    if (total >= 3600)
      text << total / 3600 << " h " << std::setw(2) << total / 60 % 60
           << " min";
    else if (total >= 60)
      text << total / 60 << " min " << std::setw(2) << total % 60 << " s";
    else
      text << total << " s";
    return text.str();
  }
} // namespace Voussoir
