#include <voussoir/base/log.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>

namespace Voussoir
{
  Log::Log(const MPI_Comm communicator, const bool quiet)
    : mpi_communicator(communicator)
    , speaks(dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    , quiet(quiet)
  {}


  void
  Log::open(const std::string &filename, const bool append)
  {
    missing.clear();
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
    if (!quiet)
      std::cout << text << std::flush;
    file.append(text);
    if (!file.name().empty())
      attempted(file.name(), file.flush());
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
    else if (missing.erase(file) > 0)
      line("All of \"", file, "\" is written now.");
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
