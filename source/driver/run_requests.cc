#include <voussoir/base/interruption.h>
#include <voussoir/driver/run_requests.h>

#include <filesystem>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Interval of polls [s]: a batch system may kill the process a second after
    // its signal. Largest number of steps between two polls, since short runs
    // of small models end within that interval.
    constexpr double poll_interval = 0.01, poll_steps = 100.;
  } // namespace


  RunRequests::RunRequests(const OutputParameters &parameters,
                           const ResultFolder     &folder,
                           Log                    &log)
    : checkpoint_interval(60. * parameters.checkpoint_interval)
    , folder(folder)
    , log(log)
  {}


  void
  RunRequests::start(const unsigned long long step)
  {
    last_poll = next_poll = step;
    since_checkpoint.restart();
    since_poll.restart();
  }


  bool
  RunRequests::are_due(const unsigned long long step) const
  {
    return step >= next_poll;
  }


  void
  RunRequests::checkpoint_tried()
  {
    since_checkpoint.restart();
  }


  RunRequests::Requests
  RunRequests::poll(const unsigned long long step)
  {
    // the first rank polls the clock and the folder; any rank may have got a
    // signal
    enum
    {
      report,
      save,
      stop,
      steps,
      n_wishes
    };
    std::vector<double> mine(n_wishes), wanted(n_wishes);
    mine[stop] = stop_requested();
    mine[save] = take_checkpoint_request();
    if (Utilities::MPI::this_mpi_process(log.communicator()) == 0)
      {
        mine[report] = log.progress_is_due();
        if (checkpoint_interval > 0. &&
            since_checkpoint.wall_time() > checkpoint_interval)
          mine[save] = 1.;
        if (folder.exists() && since_stop_file.wall_time() > 0.5)
          {
            std::error_code none;
            mine[stop] =
              std::filesystem::remove(folder.path() + "/stop", none) ||
              mine[stop] > 0.;
            since_stop_file.restart();
          }
        const double of_step =
          since_poll.wall_time() / std::max<double>(step - last_poll, 1.);
        mine[steps] =
          std::min(poll_interval / std::max(of_step, 1e-9), poll_steps);
      }
    Utilities::MPI::max(mine, log.communicator(), wanted);
    last_poll = step;
    next_poll = step + 1 + static_cast<unsigned long long>(wanted[steps]);
    since_poll.restart();
    return {wanted[report] > 0., wanted[save] > 0., wanted[stop] > 0.};
  }
} // namespace Voussoir
