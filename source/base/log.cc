#include <voussoir/base/log.h>

#include <cmath>
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
    if (!speaks)
      return;
    file.open(filename, append ? std::ios::app : std::ios::trunc);
    file << said_before_open << std::flush;
  }


  void
  Log::operator()(const std::string &text)
  {
    if (!speaks)
      return;
    if (!quiet)
      std::cout << text << std::flush;
    if (file.is_open())
      file << text << std::flush;
    else
      said_before_open += text;
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
