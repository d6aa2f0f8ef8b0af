#include <voussoir/output/table.h>

#include <cmath>
#include <iomanip>
#include <sstream>

namespace Voussoir
{
  std::string
  csv_heading(const std::vector<std::string> &titles)
  {
    std::ostringstream line;
    for (std::size_t i = 0; i < titles.size(); ++i)
      {
        line << (i > 0 ? "," : "");
        // quoted() doubles the quotation marks inside, as RFC 4180 has it
        if (titles[i].find_first_of(",\"\r\n") != std::string::npos)
          line << std::quoted(titles[i], '"', '"');
        else
          line << titles[i];
      }
    return line.str();
  }


  std::string
  csv_line(const std::vector<double> &values)
  {
    std::ostringstream line;
    line << std::setprecision(9);
    for (std::size_t i = 0; i < values.size(); ++i)
      {
        line << (i > 0 ? "," : "");
        // there is no such number, as the safety of what bears no shear
        if (!std::isinf(values[i]))
          line << values[i];
      }
    return line.str();
  }


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
        std::vector<std::string> titles = columns;
        titles.insert(titles.begin(), "time [s]");
        lines.push_back(csv_heading(titles));
      }
    file = std::ofstream(filename);
    for (const std::string &line : lines)
      file << line << '\n';
    file.flush();
  }


  void
  TimeTable::write(const double time, const std::vector<double> &values)
  {
    if (!file.is_open())
      return;
    std::vector<double> line{time};
    line.insert(line.end(), values.begin(), values.end());
    file << csv_line(line) << '\n';
  }


  void
  TimeTable::flush()
  {
    file.flush();
  }
} // namespace Voussoir
