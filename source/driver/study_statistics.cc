#include <voussoir/driver/study_statistics.h>
#include <voussoir/files/table.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Voussoir
{
  namespace
  {
    constexpr std::array<double, 3> shares{{0.16, 0.5, 0.84}};


    std::string
    text_of(const std::optional<double> &number)
    {
      return number ? number_text(*number) : std::string();
    }
  } // namespace


  Statistics::Statistics(const Sample &sample, const double beyond)
  {
    std::vector<double> all;
    double              sum = 0.;
    for (const std::optional<double> &value : sample)
      {
        all.push_back(value.value_or(beyond));
        if (value)
          {
            sum += *value;
            ++n;
          }
      }
    if (n > 0)
      mean = sum / n;
    if (n > 1)
      {
        double squares = 0.;
        for (const std::optional<double> &value : sample)
          if (value)
            squares += (*value - *mean) * (*value - *mean);
        deviation = std::sqrt(squares / (n - 1));
      }

    // linear between the sorted values, the first at 0 and the last at 1
    std::sort(all.begin(), all.end());
    for (unsigned int i = 0; i < shares.size() && !all.empty(); ++i)
      {
        const double      place = shares[i] * (all.size() - 1);
        const std::size_t below = std::floor(place), above = std::ceil(place);
        const double      value =
          below == above ?
                 all[below] :
                 all[below] + (place - below) * (all[above] - all[below]);
        if (std::isfinite(value))
          fractiles[i] = value;
      }
  }


  std::string
  statistics_table(const std::vector<StudySample> &samples,
                   const std::vector<std::string> &spread_entries,
                   const std::vector<std::string> &names)
  {
    const auto               groups = grouped(samples, spread_entries);
    std::vector<std::string> heading;
    for (const auto &item : groups.at(0).others)
      heading.push_back(item.first);
    for (const char *title : {"quantity",
                              "runs",
                              "ended early",
                              "mean",
                              "standard deviation",
                              "16 %",
                              "median",
                              "84 %"})
      heading.emplace_back(title);
    std::string text = csv_heading(heading) + '\n';
    for (const auto &group : groups)
      for (unsigned int q = 0; q < names.size(); ++q)
        {
          Sample sample;
          for (const StudySample *run : group.runs)
            sample.push_back(run->quantities[q]);
          constexpr double infinity = std::numeric_limits<double>::infinity();
          const Statistics found(sample,
                                 is_smallest(names[q]) ? -infinity : infinity);
          std::vector<std::string> line;
          for (const auto &item : group.others)
            line.push_back(item.second);
          for (const std::string &item :
               {names[q],
                std::to_string(sample.size()),
                std::to_string(sample.size() - found.n),
                text_of(found.mean),
                text_of(found.deviation),
                text_of(found.fractiles[0]),
                text_of(found.fractiles[1]),
                text_of(found.fractiles[2])})
            line.push_back(item);
          text += csv_heading(line) + '\n';
        }
    return text;
  }
} // namespace Voussoir
