#include <voussoir/base/parse_numbers.h>
#include <voussoir/files/table.h>

#include <cmath>
#include <fstream>
#include <iomanip>

namespace Voussoir
{
  namespace
  {
    /** Whether a spreadsheet would read a text as a formula because of its
     *  first character; an apostrophe before it prevents that. Numbers are
     *  safe. */
    bool
    is_like_formula(const std::string &text)
    {
      return text.find_first_of("=+-@\t\r") == 0 && !parse_number(text);
    }
  } // namespace


  std::string
  csv_heading(const std::vector<std::string> &titles)
  {
    std::ostringstream line;
    for (std::size_t i = 0; i < titles.size(); ++i)
      {
        line << (i > 0 ? "," : "");
        const std::string cell =
          (is_like_formula(titles[i]) ? "'" : "") + titles[i];
        // quoted() doubles the quotation marks inside, after RFC 4180
        if (cell.find_first_of(",\"\r\n") != std::string::npos)
          line << std::quoted(cell, '"', '"');
        else
          line << cell;
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
        // infinite stands for undefined, as the safety of a surface without
        // shear
        if (!std::isinf(values[i]))
          line << values[i];
      }
    return line.str();
  }


  std::uintmax_t
  size_before(const std::string &filename, const double time)
  {
    std::ifstream  file(filename);
    std::uintmax_t size = 0;
    for (std::string line; std::getline(file, line) && !file.eof();
         size += line.size() + 1)
      {
        char        *end    = nullptr;
        const double number = std::strtod(line.c_str(), &end);
        if (end != line.c_str() && number >= time)
          break;
      }
    return size;
  }


  std::string
  csv_of_columns(const std::vector<std::string>         &titles,
                 const std::vector<std::vector<double>> &columns)
  {
    std::string text = csv_heading(titles) + '\n';
    for (std::size_t i = 0; i < columns[0].size(); ++i)
      {
        std::vector<double> line;
        for (const std::vector<double> &column : columns)
          line.push_back(column[i]);
        text += csv_line(line) + '\n';
      }
    return text;
  }


  void
  TimeTable::open(Log                            &log,
                  const std::string              &filename,
                  const std::vector<std::string> &columns,
                  const double                    time_step,
                  const double                    start_time,
                  const bool                      restarted)
  {
    this->log = &log;
    if (dealii::Utilities::MPI::this_mpi_process(log.communicator()) != 0)
      return;
    const std::uintmax_t kept =
      restarted ? size_before(filename, start_time - 0.5 * time_step) : 0;
    file = log.grow(filename, kept);
    if (kept == 0)
      {
        std::vector<std::string> titles = columns;
        titles.insert(titles.begin(), "time [s]");
        file->append(csv_heading(titles) + '\n');
        flush();
      }
    // After a restart the table stays unchanged until its first line is
    // written. The checkpoint's size includes the line at the start time, which
    // is written anew.
  }


  void
  TimeTable::write(const double time, const std::vector<double> &values)
  {
    if (!file)
      return;
    std::vector<double> line{time};
    line.insert(line.end(), values.begin(), values.end());
    file->append(csv_line(line) + '\n');
  }


  void
  TimeTable::flush()
  {
    if (file)
      log->write(*file);
  }
} // namespace Voussoir
