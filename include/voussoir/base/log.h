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

    /** Writes a warning, and again at the end and in the summary of a run.
     *  Warnings are not repeated.
     */
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
     * failure does not stop a run, but is a warning.
     *
     * @param reason of the failure, see reason_of(); empty: all is written
     * @param remark on the part that was not written
     */
    void
    attempted(const std::string &file,
              const std::string &reason,
              const std::string &remark = "");

    /** Files that are not, or not completely, written, each with the reason;
     *  all ranks must call this together. */
    std::map<std::string, std::string>
    missing_files() const;

    /**
     * A file of the results that grows, on the first rank, from these bytes on.
     * Appended text is on the disk before each checkpoint, see
     * write_growing_files().
     */
    std::shared_ptr<GrowingFile>
    grow(const std::string &filename, const std::uintmax_t keep);

    /** Writes the text that waits in memory for one of them. */
    void
    write(GrowingFile &grown);

    /** Writes the text that waits in memory for all of them; returns whether
     *  all of it is written. All ranks must call this together. */
    bool
    write_growing_files();

    /** Sizes of the growing files, from which a run can continue [bytes], by
     *  name; all ranks must call this together. */
    std::map<std::string, std::uint64_t>
    sizes_of_growing_files() const;

    /** Records which files that were written are missing or changed. */
    void
    check_for_lost_files();

    MPI_Comm
    communicator() const;

  private:
    void
    add_warning(const std::string &text);

    /** On the terminal. */
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

    // on the first rank: files that are missing, with the reason; sizes of
    // those that were written [bytes]; those that grow
    std::map<std::string, std::string>      missing;
    std::map<std::string, std::uintmax_t>   sizes;
    std::vector<std::weak_ptr<GrowingFile>> growing;
  };

  /** "1 h 05 min", "3 min 20 s", "12 s". */
  std::string
  duration_text(const double seconds);
} // namespace Voussoir

#endif
