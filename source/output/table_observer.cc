#include <voussoir/output/table_observer.h>

namespace Voussoir
{
  using namespace dealii;

  TableObserver::TableObserver(const std::string &filename,
                               const double       interval)
    : interval(interval)
    , filename(filename)
  {}


  void
  TableObserver::declare_interval(ParameterHandler  &prm,
                                  const std::string &description)
  {
    prm.add_parameter("Interval",
                      interval,
                      description,
                      Patterns::Double(1e-6));
  }


  void
  TableObserver::open_table(const std::vector<std::string> &columns)
  {
    lines   = Schedule(interval, run().time_step);
    samples = Schedule(run().sampling_interval(interval), run().time_step);
    waiting.clear();
    table.open(run().log,
               run().folder + "/" + filename,
               columns,
               run().time_step,
               run().start_time,
               run().restarted);
  }


  bool
  TableObserver::has_line(const unsigned long long step) const
  {
    return lines.due(step);
  }


  bool
  TableObserver::is_due(const unsigned long long step) const
  {
    return lines.due(step) || samples.due(step);
  }


  std::vector<Sum>
  TableObserver::no_sums(const std::size_t n) const
  {
    return std::vector<Sum>(n, Sum(run().solid.discretization.reproducible));
  }


  void
  TableObserver::take(Sample &&sample)
  {
    waiting.push_back(std::move(sample));
    if (waiting.size() >= 100)
      flush();
  }


  void
  TableObserver::flush()
  {
    std::vector<Sum>    parts;
    std::vector<double> largest;
    for (const Sample &sample : waiting)
      {
        parts.insert(parts.end(), sample.parts.begin(), sample.parts.end());
        largest.insert(largest.end(),
                       sample.largest.begin(),
                       sample.largest.end());
      }
    const std::vector<double> sums = sum_over_ranks(parts, communicator());
    Utilities::MPI::max(largest, communicator(), largest);
    auto sum  = sums.begin();
    auto most = largest.begin();
    for (Sample &sample : waiting)
      {
        sample.sums.assign(sum, sum + sample.parts.size());
        std::copy_n(most, sample.largest.size(), sample.largest.begin());
        sum += sample.parts.size();
        most += sample.largest.size();
        const std::vector<double> line = line_of(sample);
        if (sample.has_line)
          table.write(sample.time, line);
      }
    table.flush();
    waiting.clear();
  }


  std::vector<double>
  TableObserver::line_of(const Sample &sample)
  {
    return sample.sums;
  }


  void
  TableObserver::keep(Extremes &extremes, const std::size_t n_columns)
  {
    constexpr double most = std::numeric_limits<double>::max();
    keep("largest", extremes.largest, std::vector<double>(n_columns, -most));
    keep("smallest", extremes.smallest, std::vector<double>(n_columns, most));
  }


  void
  TableObserver::Extremes::take(const std::vector<double> &line)
  {
    for (std::size_t k = 0; k < line.size(); ++k)
      {
        largest[k]  = std::max(largest[k], line[k]);
        smallest[k] = std::min(smallest[k], line[k]);
      }
  }
} // namespace Voussoir
