#include <voussoir/base/interruption.h>
#include <voussoir/driver/run_requests.h>

#include <filesystem>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Between two looks [s]: those who ask may kill a second later. And in
    // steps, as short runs of small models take less.
    constexpr double look_interval = 0.01, look_steps = 100.;
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
    last_look = next_look = step;
    since_checkpoint.restart();
    since_look.restart();
  }


  bool
  RunRequests::are_due(const unsigned long long step) const
  {
    return step >= next_look;
  }


  void
  RunRequests::checkpoint_tried()
  {
    since_checkpoint.restart();
  }


  RunRequests::Requests
  RunRequests::look(const unsigned long long step)
  {
    // the first rank looks at the clock and the folder; anybody may have got a
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
          since_look.wall_time() / std::max<double>(step - last_look, 1.);
        mine[steps] =
          std::min(look_interval / std::max(of_step, 1e-9), look_steps);
      }
    Utilities::MPI::max(mine, log.communicator(), wanted);
    last_look = step;
    next_look = step + 1 + static_cast<unsigned long long>(wanted[steps]);
    since_look.restart();
    return {wanted[report] > 0., wanted[save] > 0., wanted[stop] > 0.};
  }
} // namespace Voussoir
