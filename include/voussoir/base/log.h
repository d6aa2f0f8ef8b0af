#ifndef voussoir_base_log_h
#define voussoir_base_log_h

#include <voussoir/base/file.h>

#include <deal.II/base/mpi.h>

#include <chrono>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace Voussoir
{
  /** Messages of the program: on the terminal of the first rank and, once the
   *  output folder is known, in its log.txt. */
  class Log
  {
  public:
    explicit Log(const MPI_Comm communicator, const bool quiet = false);

    ~Log();

    /** Writes to this file from now on, earlier messages first; clears the list
     *  of missing files. Continues an existing file, or begins a new one. */
    void
    open(const std::string &filename, const bool append);

    /** Writes a message; the text includes its line ends. */
    void
    operator()(const std::string &text);

    template <typename... Parts>
    void
    line(const Parts &...parts)
    {
      std::ostringstream text;
      (text << ... << parts) << '\n';
      (*this)(text.str());
    }

    /** Whether a report of progress is due; only on the first rank.
     */
    bool
    progress_is_due() const;

    /** Reports the progress of a long task by its name: a bar in the last
     *  line of a terminal, which the next message overwrites; elsewhere and
     *  in log.txt a line, not more often than every five seconds. */
    void
    progress(const double share_done, const std::string &text);

    /** Writes a warning, which the end of the log and the summary of a run
     *  repeat. A second warning of the same text is ignored. */
    template <typename... Parts>
    void
    warn(const Parts &...parts)
    {
      std::ostringstream text;
      (text << ... << parts);
      add_warning(text.str());
    }

    const std::vector<std::string> &
    warnings() const;

    /**
     * Records an attempt to write a file of the results, on the first rank: a
     * failure is a warning and does not stop a run.
     *
     * @param reason of the failure, see reason_of(); empty: all is written
     * @param remark on the part that was not written
     */
    void
    attempted(const std::string &file,
              const std::string &reason,
              const std::string &remark = "");

    /** Files that are not written, or not completely, each with the reason; all
     *  ranks must call this together. */
    std::map<std::string, std::string>
    missing_files() const;

    /**
     * A growing file of the results on the first rank, continued after @p keep
     * bytes. Appended text is on the disk before each checkpoint, see
     * write_growing_files().
     */
    std::shared_ptr<GrowingFile>
    grow(const std::string &filename, const std::uintmax_t keep);

    /** Writes the waiting text of one growing file. */
    void
    write(GrowingFile &grown);

    /** Writes the waiting text of all growing files; returns whether all of it
     *  is written. All ranks must call this together. */
    bool
    write_growing_files();

    /** Sizes of the growing files, from which a run can continue [bytes], by
     *  name; all ranks must call this together. */
    std::map<std::string, std::uint64_t>
    sizes_of_growing_files() const;

    /** Records which of the written files are missing or changed. */
    void
    check_for_lost_files();

    MPI_Comm
    communicator() const;

  private:
    void
    add_warning(const std::string &text);

    /** Shows a text on the terminal. */
    void
    show(const std::string &text);

    void
    write(const std::string &text);

    MPI_Comm    mpi_communicator;
    const bool  speaks, quiet, has_bar;
    bool        shows_bar = false;
    GrowingFile file; // messages wait until it is open

    using Clock = std::chrono::steady_clock;
    Clock::time_point last_bar, last_line; // of progress

    std::vector<std::string> all_warnings;

    // on the first rank: missing files with the reason; sizes of the written
    // files [bytes]; growing files
    std::map<std::string, std::string>      missing;
    std::map<std::string, std::uintmax_t>   sizes;
    std::vector<std::weak_ptr<GrowingFile>> growing;
  };

  /** "1 h 05 min", "3 min 20 s", "12 s". */
  std::string
  duration_text(const double seconds);
} // namespace Voussoir

#endif
