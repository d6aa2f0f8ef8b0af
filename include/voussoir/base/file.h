#ifndef voussoir_base_file_h
#define voussoir_base_file_h

#include <deal.II/base/mpi.h>

#include <cstdint>
#include <string>

namespace Voussoir
{
  /** Reason why a file that was written is missing. */
  inline constexpr char removed_meanwhile[] =
    "it was removed while the run went on";

  /** Meaning of an error number of the system, as the end of a sentence: "...
   *  because the disk is full". */
  std::string
  reason_of(const int error);

  /**
   * Writes a file under a temporary name and renames it, so that the name
   * always belongs to a whole file, the old or the new one. A device or a pipe
   * is written to directly.
   *
   * @return reason of a failure, see reason_of(); empty: written
   */
  std::string
  write_file(const std::string &name, const std::string &text);

  /**
   * The same with one part from each rank, in the order of ranks; makes the
   * folder of the file. All ranks must call this together; the result is the
   * same on all.
   */
  std::string
  write_file_in_parts(const std::string &name,
                      const std::string &part,
                      const MPI_Comm     communicator);

  /** A lock between programs, which the system releases when the program ends
   *  for whatever reason. On file systems without locks every program gets it.
   */
  class FileLock
  {
  public:
    FileLock()                 = default;
    FileLock(const FileLock &) = delete;
    ~FileLock();

    /** Takes the lock of this file, which is made if need be; returns whether
     *  no other program has the lock. */
    bool
    take(const std::string &name);

    static bool
    is_taken(const std::string &name);

  private:
    bool
    open(const std::string &name, const int mode);

    int file = -1;
  };

  /** A text file that grows. Text that cannot be written waits in memory and is
   *  written with the next text; the file never holds a part of a text. A file
   *  that was removed, replaced or cut off meanwhile is not made anew, as its
   *  beginning would be lost. */
  class GrowingFile
  {
  public:
    /** Continues this file after @p keep bytes; 0: begins a new file. */
    void
    open(const std::string &name, const std::uintmax_t keep = 0);

    /** Name of the file; empty: not open. */
    const std::string &
    name() const;

    /** Size of the written part [bytes]. */
    std::uintmax_t
    size() const;

    void
    append(const std::string &text);

    /** Writes the waiting text; returns the reason of a failure, see
     *  reason_of(). */
    std::string
    flush();

    bool
    has_waiting() const;

  private:
    /** Reason why the written part is lost; empty: it is not. */
    std::string
    loss() const;

    std::string    file_name, waiting;
    std::uintmax_t written       = 0; // bytes
    std::uint64_t  serial_number = 0; // inode number of the file
  };
} // namespace Voussoir

#endif
