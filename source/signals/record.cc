#include <voussoir/base/error.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/signals/record.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>

namespace Voussoir
{
  namespace
  {
    struct Line
    {
      unsigned int number;
      std::string  text;
    };

    [[noreturn]] void
    refuse(const std::string &file, const std::string &complaint)
    {
      throw UserError("Record '" + file + "': " + complaint + ".");
    }

    [[noreturn]] void
    refuse(const std::string &file,
           const Line        &line,
           const std::string &complaint)
    {
      throw UserError("Record '" + file + "', line " +
                      std::to_string(line.number) + ": " + complaint + ".");
    }

    /** The lines that are neither empty nor comments. */
    std::vector<Line>
    read_lines(const std::string &file)
    {
      // a read of a pipe would block
      std::error_code error;
      std::ifstream   stream;
      if (std::filesystem::is_regular_file(file, error))
        stream.open(file);
      if (!stream.is_open())
        refuse(file,
               "there is no such file to read; give its path relative to the "
               "folder of the parameter file, or absolute");

      std::vector<Line> lines;
      std::string       text;
      for (unsigned int number = 1; std::getline(stream, text); ++number)
        {
          const std::string byte_order_mark = "\xEF\xBB\xBF";
          if (number == 1 && text.compare(0, 3, byte_order_mark) == 0)
            text.erase(0, 3);

          const std::size_t first = text.find_first_not_of(" \t\r");
          if (first == std::string::npos)
            continue;
          if (std::string("#%!").find(text[first]) != std::string::npos ||
              text.compare(first, 2, "//") == 0)
            continue;
          lines.push_back({number, text.substr(first)});
        }
      if (lines.empty())
        refuse(file, "the file is empty; it must hold accelerations");
      return lines;
    }

    std::vector<std::string>
    words(const std::string &text)
    {
      std::vector<std::string> result;
      const std::string        separators = " \t\r,;";
      std::size_t              end        = 0;
      while (true)
        {
          const std::size_t begin = text.find_first_not_of(separators, end);
          if (begin == std::string::npos)
            return result;
          end = std::min(text.find_first_of(separators, begin), text.size());
          result.push_back(text.substr(begin, end - begin));
        }
    }

    /** Whether a word is a number as C++ or Fortran (exponent D) writes it. */
    std::optional<double>
    to_number(std::string word)
    {
      std::replace_if(
        word.begin(),
        word.end(),
        [](const char c) { return c == 'D' || c == 'd'; },
        'E');
      const char *begin = word.data() + (word.front() == '+' ? 1 : 0);
      const char *end   = word.data() + word.size();

      double value             = 0;
      const auto [rest, error] = std::from_chars(begin, end, value);
      if (error != std::errc() || rest != end || begin == end)
        return {};
      return value;
    }

    /** Whether the first @p n words, or all if there are fewer, are numbers. */
    bool
    starts_with_numbers(const Line &line, const std::size_t n)
    {
      const std::vector<std::string> all = words(line.text);
      return !all.empty() && std::all_of(all.begin(),
                                         all.begin() + std::min(n, all.size()),
                                         [](const std::string &word) {
                                           return to_number(word).has_value();
                                         });
    }

    std::vector<double>
    numbers(const std::string &file, const Line &line)
    {
      std::vector<double> result;
      for (const std::string &word : words(line.text))
        {
          const std::optional<double> number = to_number(word);
          if (!number)
            refuse(file,
                   line,
                   "'" + word +
                     "' is not a number; below the header only numbers are "
                     "allowed");
          if (!(std::abs(*number) <= largest_number))
            refuse(file,
                   line,
                   "'" + word + "' is no acceleration; repair the record");
          result.push_back(*number);
        }
      return result;
    }

    /** The beginning of a line, long enough for a header. */
    std::string
    beginning(const Line &line)
    {
      return line.text.substr(0, 200);
    }

    /** Header of an AT2 file. */
    struct Header
    {
      std::size_t n_points  = 0;
      double      time_step = 0;
      /** Index of the first line of numbers. */
      std::size_t end = 0;
    };

    /** The header of an AT2 file; nothing if the file is not of that kind. */
    std::optional<Header>
    find_at2_header(const std::string &file, const std::vector<Line> &lines)
    {
      const std::string number =
        R"(([0-9]*\.?[0-9]+(?:E[-+]?[0-9]+)?|[0-9]+\.))";
      const auto       flags = std::regex::icase;
      const std::regex both_before_words("([0-9]{1,9})[ ,]+" + number +
                                           "[ ,]+NPTS[ ,]+DT\\b",
                                         flags);
      const std::regex points("\\bNPTS *[=:]? *([0-9]{1,9})", flags);
      const std::regex step("\\bDT *[=:]? *" + number, flags);

      constexpr std::size_t longest_header = 20;

      Header header;
      for (std::size_t i = 0; i < std::min(lines.size(), longest_header); ++i)
        {
          const bool complete = header.n_points > 0 && header.time_step > 0;
          // A heading like "1559 points" has one number at most.
          if (complete && starts_with_numbers(lines[i], 2))
            {
              header.end = i;
              return header;
            }
          const std::string text = beginning(lines[i]);
          std::smatch       match;
          if (std::regex_search(text, match, both_before_words))
            {
              header.n_points  = std::stoul(match[1]);
              header.time_step = to_number(match[2]).value_or(0);
              continue;
            }
          if (std::regex_search(text, match, points))
            header.n_points = std::stoul(match[1]);
          if (std::regex_search(text, match, step))
            header.time_step = to_number(match[1]).value_or(0);
        }
      if (header.n_points > 0)
        refuse(file,
               "the header gives NPTS but no time step before the numbers; add "
               "it as in NPTS= 1559, DT= .0200 SEC");
      return {};
    }

    void
    check_at2_unit(const std::string       &file,
                   const std::vector<Line> &lines,
                   const Header            &header,
                   const AccelerationUnit   unit)
    {
      for (std::size_t i = 0; i < header.end; ++i)
        {
          if (std::regex_search(beginning(lines[i]),
                                std::regex("(VELOCITY|DISPLACEMENT) +TIME",
                                           std::regex::icase)))
            refuse(file,
                   lines[i],
                   "the header announces velocity or displacement; give the "
                   "file of the acceleration");
          if (unit != AccelerationUnit::g &&
              std::regex_search(beginning(lines[i]),
                                std::regex("UNITS OF G\\b", std::regex::icase)))
            refuse(file,
                   lines[i],
                   "the header gives the unit g but the entry Unit says " +
                     option_name(unit) + "; set Unit = g");
        }
    }

    TimeSeries
    read_at2(const std::string       &file,
             const std::vector<Line> &lines,
             const Header            &header,
             const RecordFormat      &format)
    {
      check_at2_unit(file, lines, header, format.unit);
      if (format.time_step > 0 &&
          std::abs(format.time_step / header.time_step - 1.) > 1e-3)
        refuse(file,
               "the header gives the time step " +
                 std::to_string(header.time_step) +
                 " s, another one than the entry Time step; set Time step = 0");

      TimeSeries series{header.time_step, {}};
      for (std::size_t i = header.end; i < lines.size(); ++i)
        for (const double number : numbers(file, lines[i]))
          series.values.push_back(number);

      if (series.values.size() != header.n_points)
        refuse(file,
               "the header announces NPTS = " +
                 std::to_string(header.n_points) + " values but " +
                 std::to_string(series.values.size()) +
                 " follow; use a complete file");
      return series;
    }

    /** The constant step of the time column, the first of each row. Times may
     *  be rounded: each step may differ by a fifth from the usual one, and each
     *  time by a fifth of a step from its place at equal steps. */
    double
    uniform_step(const std::string                      &file,
                 const std::vector<Line>                &lines,
                 const std::size_t                       first_line,
                 const std::vector<std::vector<double>> &rows)
    {
      constexpr double    rounding = 0.2; // of a step
      std::vector<double> steps;
      for (std::size_t i = 1; i < rows.size(); ++i)
        {
          steps.push_back(rows[i][0] - rows[i - 1][0]);
          if (!(steps.back() > 0.))
            refuse(file,
                   lines[first_line + i],
                   "the first of " + std::to_string(rows[i].size()) +
                     " columns is the time [s], but it does not increase; sort "
                     "the rows and remove repeated ones, or, if these are "
                     "accelerations alone, write one in each row with the "
                     "entry Time step, or give the header with NPTS and DT");
        }
      std::vector<double> sorted = steps;
      const auto          middle = sorted.begin() + sorted.size() / 2;
      std::nth_element(sorted.begin(), middle, sorted.end());
      const double usual = *middle, mean = (rows.back()[0] - rows.front()[0]) /
                                           double(steps.size());
      for (std::size_t i = 1; i < rows.size(); ++i)
        {
          const double step = steps[i - 1];
          if (std::abs(step - usual) > rounding * usual)
            refuse(file,
                   lines[first_line + i],
                   "the time step " + std::to_string(step) +
                     " s differs from the usual " + std::to_string(usual) +
                     " s; fill the gap or resample the record");
        }
      for (std::size_t i = 1; i < rows.size(); ++i)
        if (const double equal = rows.front()[0] + double(i) * mean;
            std::abs(rows[i][0] - equal) > rounding * mean)
          refuse(file,
                 lines[first_line + i],
                 "the time " + std::to_string(rows[i][0]) + " s would be " +
                   std::to_string(equal) +
                   " s at equal steps; resample the record at equal steps");
      return mean;
    }

    TimeSeries
    read_columns(const std::string       &file,
                 const std::vector<Line> &lines,
                 const RecordFormat      &format)
    {
      const auto first =
        std::find_if(lines.begin(), lines.end(), [](const Line &line) {
          return starts_with_numbers(line, 1);
        });
      if (first == lines.end())
        refuse(file, "there are no numbers; the file must hold accelerations");
      const std::size_t first_line = first - lines.begin();

      std::vector<std::vector<double>> rows;
      for (std::size_t i = first_line; i < lines.size(); ++i)
        {
          rows.push_back(numbers(file, lines[i]));
          if (rows.back().size() != rows.front().size())
            refuse(file,
                   lines[i],
                   "this row has " + std::to_string(rows.back().size()) +
                     " columns and the first one " +
                     std::to_string(rows.front().size()) +
                     "; all rows must be alike");
        }
      if (rows.size() < 2)
        refuse(file,
               "there is one row of numbers only; at least two are "
               "needed");

      const bool         has_time  = rows.front().size() > 1;
      const unsigned int n_columns = rows.front().size() - (has_time ? 1 : 0);
      if (format.column > n_columns)
        refuse(file,
               "column " + std::to_string(format.column) +
                 " of the accelerations is asked for, but there are " +
                 std::to_string(n_columns) + " (the time column not counted)");
      if (has_time && format.time_step > 0)
        refuse(file,
               "with several columns the first one is the time; set Time step "
               "= 0");
      if (!has_time && !(format.time_step > 0))
        refuse(file,
               "with a single column the time step is missing; set Time step");

      TimeSeries series{has_time ? uniform_step(file, lines, first_line, rows) :
                                   format.time_step,
                        {}};
      for (const std::vector<double> &row : rows)
        series.values.push_back(row[format.column - (has_time ? 0 : 1)]);
      return series;
    }
  } // namespace


  TimeSeries
  read_record(const std::string &file, const RecordFormat &format)
  {
    const std::map<AccelerationUnit, double> units = {
      {AccelerationUnit::g, standard_gravity},
      {AccelerationUnit::m_per_s2, 1.},
      {AccelerationUnit::cm_per_s2, .01}};

    const std::vector<Line>     lines  = read_lines(file);
    const std::optional<Header> header = find_at2_header(file, lines);

    TimeSeries series = header ? read_at2(file, lines, *header, format) :
                                 read_columns(file, lines, format);
    for (double &value : series.values)
      value *= units.at(format.unit);
    return series;
  }
} // namespace Voussoir
