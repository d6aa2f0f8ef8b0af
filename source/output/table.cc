#include <voussoir/output/table.h>

#include <iomanip>

namespace Voussoir
{
  void
  TimeTable::open(const MPI_Comm                  communicator,
                  const std::string              &filename,
                  const std::vector<std::string> &columns,
                  const double                    time_step,
                  const double                    start_time,
                  const bool                      restarted)
  {
    if (dealii::Utilities::MPI::this_mpi_process(communicator) != 0)
      return;
    std::vector<std::string> lines;
    if (restarted)
      {
        std::ifstream old(filename);
        for (std::string line; std::getline(old, line);)
          if (lines.empty() ||
              std::strtod(line.c_str(), nullptr) < start_time - 0.5 * time_step)
            lines.push_back(line);
      }
    if (lines.empty())
      {
        lines.push_back("time [s]");
        for (const std::string &column : columns)
          lines.back() += ',' + column;
      }
    file.open(filename);
    file << std::setprecision(9);
    for (const std::string &line : lines)
      file << line << '\n';
    file.flush();
  }


  void
  TimeTable::write(const double time, const std::vector<double> &values)
  {
    if (!file.is_open())
      return;
    file << time;
    for (const double value : values)
      file << ',' << value;
    file << '\n';
  }


  void
  TimeTable::flush()
  {
    file.flush();
  }
} // namespace Voussoir
