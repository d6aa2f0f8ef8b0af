#ifndef voussoir_driver_result_folder_h
#define voussoir_driver_result_folder_h

#include <voussoir/base/log.h>
#include <voussoir/driver/case.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /** How the command line wants a case to be run. */
  struct RunOptions
  {
    bool restart   = false;
    bool overwrite = false;
    bool quiet     = false;

    /** No output folder: for tests that look at the state themselves. */
    bool no_output = false;

    /** Set up for checks only: no static state, no modes. */
    bool validate = false;
  };

  /** Where the results of a run go, and the checkpoint there that it goes on
   *  from. */
  class ResultFolder
  {
  public:
    /**
     * Chooses the folder: the one that the case names, with the next free
     * number added if it exists; a restart goes on in the one with the newest
     * checkpoint. Throws UserError if it must not be overwritten, or if there
     * is no checkpoint, or one of other physics.
     */
    ResultFolder(const Case &parameters, const RunOptions &options, Log &log);

    /** Makes the folder, in it the parameters as run, and lets the log write
     *  there. */
    void
    make(Log &log) const;

    /** Empty: no output. */
    std::string
    path() const;

    bool
    exists() const;

    bool
    restarts() const;

    /** Where the checkpoints are. */
    std::string
    checkpoints() const;

    /** The checkpoint that a restart goes on from. */
    const std::string &
    checkpoint_file() const;

    /** Its header. */
    const nlohmann::json &
    checkpoint() const;

    /** Simulated time at which the run starts [s]. */
    double
    start_time() const;

  private:
    /** Takes the newest checkpoint that is whole, in an older folder if the
     *  newest one has none. */
    void
    find_checkpoint(Log &log);

    const Case      &parameters;
    const RunOptions options;
    std::string      chosen;
    std::string      from; // file of the checkpoint
    nlohmann::json   header;
  };
} // namespace Voussoir

#endif
