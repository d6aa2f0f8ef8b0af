#ifndef voussoir_tests_csv_table_h
#define voussoir_tests_csv_table_h

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace Voussoir
{
  /** A file of comma-separated values, as text; no title has a comma. */
  struct CsvTable
  {
    explicit CsvTable(const std::string &filename)
    {
      std::ifstream in(filename);
      std::string   line;
      while (std::getline(in, line))
        {
          std::vector<std::string> cells(1);
          for (const char c : line)
            if (c == ',')
              cells.emplace_back();
            else
              cells.back() += c;
          lines.push_back(cells);
        }
      if (lines.size() < 2)
        throw std::runtime_error(filename + " has no lines");
    }

    /** The cells below a title, as they are written. */
    std::vector<std::string>
    texts(const std::string &title) const
    {
      const auto &titles = lines.front();
      const auto  found  = std::find(titles.begin(), titles.end(), title);
      if (found == titles.end())
        throw std::runtime_error("there is no column \"" + title + '"');
      std::vector<std::string> result;
      for (std::size_t i = 1; i < lines.size(); ++i)
        result.push_back(lines[i].at(found - titles.begin()));
      return result;
    }

    std::vector<double>
    numbers(const std::string &title) const
    {
      std::vector<double> result;
      for (const std::string &text : texts(title))
        result.push_back(std::stod(text));
      return result;
    }

    std::vector<std::vector<std::string>> lines;
  };
} // namespace Voussoir

#endif
