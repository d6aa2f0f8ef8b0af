#ifndef voussoir_driver_result_folder_h
#define voussoir_driver_result_folder_h

#include <voussoir/base/file.h>
#include <voussoir/base/log.h>
#include <voussoir/driver/case.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /** Removes incomplete files that a killed run left in a folder, and the locks
   *  of Open MPI beside them.
   *  @param start of their names */
  void
  remove_unfinished(const std::string &folder, const std::string &start = "");

  /** Folder that a case names for its results, without a number. */
  std::string
  name_of_results(const Case &parameters);

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

  /** The output folder of a run, and the checkpoint there from which the run
   *  continues. */
  class ResultFolder
  {
  public:
    /**
     * Chooses the folder without writing: the folder that the case names, with
     * the next free number added if it exists; a restart continues in the
     * folder with the newest checkpoint. Throws UserError if the folder cannot
     * be written to or must not be overwritten, if another run is writing
     * there, or if there is no checkpoint, or only one of a different case.
     */
    ResultFolder(const Case &parameters, const RunOptions &options, Log &log);

    /** Claims the folder for this run alone, writes the parameters as run into
     *  it, and opens the log there. Throws UserError if that is impossible. */
    void
    claim(Log &log);

    /** Whether the run has an output folder. */
    bool
    wanted() const;

    /** Whether the folder is claimed. */
    bool
    exists() const;

    /** The claimed folder; empty: none is claimed. */
    std::string
    path() const;

    bool
    restarts() const;

    /** Folder of the checkpoints. */
    std::string
    checkpoints() const;

    /** The checkpoint that a restart continues from. */
    const std::string &
    checkpoint_file() const;

    /** Header of this checkpoint. */
    const nlohmann::json &
    checkpoint() const;

    /** Simulated time at which the run starts [s]. */
    double
    start_time() const;

  private:
    /** Chooses the newest whole checkpoint, in an older folder if the newest
     *  one has none. */
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
