#include <voussoir/base/interruption.h>

#include <csignal>

namespace Voussoir
{
  namespace
  {
    volatile std::sig_atomic_t stop_flag = 0, checkpoint_flag = 0;

    void
    on_stop(const int signal)
    {
      stop_flag = 1;
      if (signal == SIGINT)
        std::signal(SIGINT, SIG_DFL);
    }

    void
    on_checkpoint(int)
    {
      checkpoint_flag = 1;
    }
  } // namespace


  void
  listen_to_signals()
  {
    stop_flag = checkpoint_flag = 0;
    for (const int signal : {SIGINT, SIGTERM, SIGXCPU, SIGUSR2})
      std::signal(signal, on_stop);
    // nohup ignores it
    if (std::signal(SIGHUP, on_stop) == SIG_IGN)
      std::signal(SIGHUP, SIG_IGN);
    std::signal(SIGUSR1, on_checkpoint);
  }


  bool
  stop_requested()
  {
    return stop_flag != 0;
  }


  bool
  take_checkpoint_request()
  {
    const bool requested = checkpoint_flag != 0;
    checkpoint_flag      = 0;
    return requested;
  }


  void
  stop(const std::string &sentence)
  {
    stop_flag = 0;
    throw Stopped(sentence);
  }


  void
  stop_if_requested(const MPI_Comm communicator)
  {
    if (dealii::Utilities::MPI::max(stop_requested() ? 1 : 0, communicator))
      stop("Stopped on request before the first step; start the case again.");
  }
} // namespace Voussoir
