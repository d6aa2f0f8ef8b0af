#include <voussoir/base/log.h>
#include <voussoir/driver/run_times.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  RunTimes::RunTimes(const types::global_dof_index n_unknowns)
    : sections(std::cout, TimerOutput::never, TimerOutput::wall_times)
    , n_unknowns(n_unknowns)
  {}


  void
  RunTimes::start(const unsigned long long step)
  {
    first_step = step;
    clock.restart();
  }


  void
  RunTimes::stop()
  {
    clock.stop();
  }


  double
  RunTimes::seconds() const
  {
    return clock.wall_time();
  }


  unsigned long long
  RunTimes::n_steps(const unsigned long long step) const
  {
    return step - first_step;
  }


  double
  RunTimes::throughput(const unsigned long long step) const
  {
    const double time = seconds();
    return time > 0. ? 1e-6 * n_unknowns * double(n_steps(step)) / time : 0.;
  }


  std::string
  RunTimes::time_left(const unsigned long long step,
                      const unsigned long long last_step) const
  {
    const double done = double(n_steps(step)) / double(n_steps(last_step));
    return "time left " + duration_text(seconds() * (1. - done) / done);
  }


  std::string
  RunTimes::table() const
  {
    std::ostringstream text;
    const auto         times =
      sections.get_summary_data(TimerOutput::OutputData::total_wall_time);
    const auto calls =
      sections.get_summary_data(TimerOutput::OutputData::n_calls);
    text << "  seconds      calls  section\n" << std::fixed;
    for (const auto &[name, seconds] : times)
      text << std::setw(9) << std::setprecision(2) << seconds << "  "
           << std::setw(9) << std::setprecision(0) << calls.at(name) << "  "
           << name << '\n';
    return text.str();
  }
} // namespace Voussoir
