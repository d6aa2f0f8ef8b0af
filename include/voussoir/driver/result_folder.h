#ifndef voussoir_driver_result_folder_h
#define voussoir_driver_result_folder_h

#include <voussoir/base/file.h>
#include <voussoir/base/log.h>
#include <voussoir/driver/case.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /** Removes what a killed run left in a folder: files without
   *  their end, and the locks of Open MPI beside them.
   *  @param start of their names */
  void
  remove_unfinished(const std::string &folder, const std::string &start = "");

  /** Options of a run from the command line. */
  struct RunOptions
  {
    bool restart   = false;
    bool overwrite = false;
    bool quiet     = false;

    /** No output folder: for tests that evaluate the state themselves. */
    bool no_output = false;

    /** For checks and estimates only: no static state, no modes, and nothing is
     *  written. */
    bool validate = false;
  };

  /** Where the results of a run go, and the checkpoint there that it continues
   *  from. */
  class ResultFolder
  {
  public:
    /**
     * Looks for the folder, but writes nothing: the one that the case names,
     * with the next free number added if it exists; a restart continues in the
     * one with the newest checkpoint. Throws UserError if it cannot be written
     * to or must not be overwritten, if another run is writing there, or if
     * there is no checkpoint, or one of a different case.
     */
    ResultFolder(const Case &parameters, const RunOptions &options, Log &log);

    /** Takes the folder for this run and no other, puts the parameters as run
     *  there, and lets the log write there. Throws UserError if that is
     *  impossible. */
    void
    claim(Log &log);

    /** Whether the run is to have one. */
    bool
    wanted() const;

    /** Whether it is claimed. */
    bool
    exists() const;

    /** Empty: not claimed. */
    std::string
    path() const;

    bool
    restarts() const;

    /** Where the checkpoints are. */
    std::string
    checkpoints() const;

    /** The checkpoint that a restart continues from. */
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

    /** Refuses to continue files that are shorter than when the checkpoint was
     *  written. */
    void
    check_sizes() const;

    const Case      &parameters;
    const RunOptions options;
    std::string      chosen; // on all ranks; another number may be claimed
    bool             claimed = false;
    FileLock         lock; // of the first rank
    std::string      from; // file of the checkpoint
    nlohmann::json   header;
  };
} // namespace Voussoir

#endif
