#ifndef voussoir_base_file_h
#define voussoir_base_file_h

#include <deal.II/base/mpi.h>

#include <cstdint>
#include <string>

namespace Voussoir
{
  /** Why a file that was written is not there any more. */
  inline constexpr char removed_meanwhile[] =
    "it was removed while the run went on";

  /** What an error number of the system means, as the end of a sentence:
   *  "... because the disk is full". */
  std::string
  reason_of(const int error);

  /**
   * Writes a file under a temporary name and renames it, so that either the
   * whole file or the one before is there. A device or a pipe is written to as
   * it is.
   *
   * @return why the writing failed, see reason_of(); empty: written
   */
  std::string
  write_file(const std::string &name, const std::string &text);

  /**
   * The same with one part from each rank, in their order; makes the folder of
   * the file. All ranks must call this together, and get the same.
   */
  std::string
  write_file_in_parts(const std::string &name,
                      const std::string &part,
                      const MPI_Comm     communicator);

  /** A lock between programs, which the system takes away when the program
   *  ends, however that comes about. On file systems without locks all get it.
   */
  class FileLock
  {
  public:
    FileLock()                 = default;
    FileLock(const FileLock &) = delete;
    ~FileLock();

    /** Takes the lock of this file, which is made if need be; returns whether
     *  nobody else has it. */
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
   * written with the next one; no part of a text is left in the file. A file
   * that was removed, replaced or cut off meanwhile is not made anew, as its
   * beginning would be lost. */
  class GrowingFile
  {
  public:
    /** Continues this file after the bytes to keep; none: a new file. */
    void
    open(const std::string &name, const std::uintmax_t keep = 0);

    /** Empty: not open. */
    const std::string &
    name() const;

    /** Size of the written part [bytes]. */
    std::uintmax_t
    size() const;

    void
    append(const std::string &text);

    /** Writes the text that waits; returns why that failed, see reason_of(). */
    std::string
    flush();

    bool
    has_waiting() const;

  private:
    /** Why the written part is lost; empty: it is there. */
    std::string
    loss() const;

    std::string    file_name, waiting;
    std::uintmax_t written       = 0; // bytes
    std::uint64_t  serial_number = 0; // of the file in its file system
  };
} // namespace Voussoir

#endif
