#include <voussoir/base/file.h>

#include <deal.II/base/mpi_large_count.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <map>
#include <system_error>

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    /** A file of the operating system that is open for writing. */
    class OpenFile
    {
    public:
      explicit OpenFile(const std::string &name, const int mode = O_CREAT)
        : number(::open(name.c_str(), O_WRONLY | O_CLOEXEC | mode, 0666))
      {}

      OpenFile(const OpenFile &) = delete;

      ~OpenFile()
      {
        if (is_open())
          ::close(number);
      }

      bool
      is_open() const
      {
        return number >= 0;
      }

      /** Ends the file at its present length; devices have no end. */
      bool
      cut(const std::uintmax_t size) const
      {
        return ::ftruncate(number, size) == 0 || errno == EINVAL;
      }

      bool
      write(const std::string &text, const std::uintmax_t place) const
      {
        // a pipe can only be written in sequence
        if (::lseek(number, place, SEEK_SET) < 0 && errno != ESPIPE)
          return false;
        for (std::size_t done = 0; done < text.size();)
          {
            const ssize_t n =
              ::write(number, text.data() + done, text.size() - done);
            if (n < 0 && errno != EINTR)
              return false;
            done += std::max<ssize_t>(n, 0);
          }
        return true;
      }

      /** Reserves space for so many bytes, where the file system can. */
      bool
      reserve(const std::uintmax_t size) const
      {
        return size == 0 || ::fallocate(number, 0, 0, size) == 0 ||
               errno == EOPNOTSUPP || errno == ENOSYS;
      }

      /** Flushes the file; some file systems report only then that there is no
       *  space. */
      bool
      close()
      {
        const int closed = number;
        number           = -1;
        return ::close(closed) == 0;
      }

    private:
      int number;
    };


    /** Writes the text to this place and ends the file behind it; if that fails
     *  the file ends at this place. A program that is killed in between has
     *  lost no data on which a checkpoint relies. */
    std::string
    put(const std::string   &name,
        const std::string   &text,
        const std::uintmax_t place)
    {
      OpenFile file(name, place == 0 ? O_CREAT : 0);
      if (!file.is_open())
        return reason_of(errno);
      if (file.write(text, place) && file.cut(place + text.size()) &&
          file.close())
        return "";
      const std::string reason = reason_of(errno);
      if (file.is_open())
        file.cut(place);
      return reason;
    }


    /** Inode number of a file; 0 if there is no file. */
    std::uint64_t
    serial_number_of(const std::string &name)
    {
      struct stat now;
      return ::stat(name.c_str(), &now) == 0 ? now.st_ino : 0;
    }


    std::string
    aside(const std::string &name)
    {
      return name + ".part";
    }


    /** Renames the temporary file, or removes it if writing failed for a
     *  reason. */
    std::string
    settle(const std::string &name, std::string reason)
    {
      std::error_code problem;
      if (reason.empty())
        {
          fs::rename(aside(name), name, problem);
          if (problem)
            reason = reason_of(problem.value());
        }
      if (!reason.empty())
        fs::remove(aside(name), problem);
      return reason;
    }


    /** Reserves space for a file of this size, so that a lack of space shows
     *  before the ranks write their parts. */
    std::string
    make_room(const std::string &name, const std::uintmax_t size)
    {
      std::error_code problem;
      // one folder only: those above it exist, or were removed on purpose
      fs::create_directory(fs::absolute(name).parent_path(), problem);
      if (problem)
        return reason_of(problem.value());
      OpenFile file(name);
      return file.is_open() && file.cut(0) && file.reserve(size) &&
                 file.close() ?
               "" :
               reason_of(errno);
    }


    /** Whether this rank wrote its part. */
    bool
    write_part(const std::string &name,
               const std::string &part,
               const MPI_Offset   place,
               const MPI_Comm     communicator)
    {
      MPI_File  file;
      const int opened = MPI_File_open(communicator,
                                       name.c_str(),
                                       MPI_MODE_CREATE | MPI_MODE_WRONLY,
                                       MPI_INFO_NULL,
                                       &file);
      // no rank must wait for a rank without a file
      if (Utilities::MPI::max(opened == MPI_SUCCESS ? 0 : 1, communicator) == 1)
        return false;
      const int written = Utilities::MPI::LargeCount::File_write_at_all_c(
        file, place, part.data(), part.size(), MPI_CHAR, MPI_STATUS_IGNORE);
      // closing does not suffice with some versions of Open MPI
      const int synchronised = MPI_File_sync(file);
      const int closed       = MPI_File_close(&file);
      return written == MPI_SUCCESS && synchronised == MPI_SUCCESS &&
             closed == MPI_SUCCESS;
    }
  } // namespace


  std::string
  reason_of(const int error)
  {
    static const std::map<int, std::string> reasons{
      {ENOSPC, "the disk is full"},
      {EDQUOT, "the quota of disk space is used up"},
      {EFBIG, "it would be larger than files may be here (ulimit -f)"},
      {EACCES, "the permission is missing"},
      {EPERM, "the permission is missing"},
      {EROFS, "the disk can only be read"},
      {EISDIR, "there is a folder of that name"},
      {ENOTDIR, "a part of its path is not a folder"},
      {ENOENT, "its folder does not exist"},
      {ENAMETOOLONG, "the name is too long"},
      {ELOOP, "a link in its path leads back to itself"},
      {EIO, "the disk or the network failed"}};
    const auto found = reasons.find(error);
    return found != reasons.end() ?
             found->second :
             "the system says: " + std::generic_category().message(error);
  }


  std::string
  write_file(const std::string &name, const std::string &text)
  {
    std::error_code problem;
    const bool      exists = fs::exists(name, problem);
    if (exists && !fs::is_regular_file(name, problem))
      return put(name, text, 0);
    // a symbolic link is kept
    const std::string target =
      exists ? fs::canonical(name, problem).string() : name;
    return settle(target, put(aside(target), text, 0));
  }


  std::string
  write_file_in_parts(const std::string &name,
                      const std::string &part,
                      const MPI_Comm     communicator)
  {
    const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;
    const std::uint64_t size  = part.size();
    const std::uint64_t total = Utilities::MPI::sum(size, communicator);
    std::uint64_t       place = 0;
    MPI_Exscan(&size, &place, 1, MPI_UINT64_T, MPI_SUM, communicator);

    std::string reason =
      Utilities::MPI::broadcast(communicator,
                                first ? make_room(aside(name), total) : "");
    if (reason.empty())
      {
        const bool mine = write_part(aside(name), part, place, communicator);
        if (Utilities::MPI::min(mine ? 1 : 0, communicator) == 0)
          reason = reason_of(EIO);
      }
    if (first)
      reason = settle(name, reason);
    return Utilities::MPI::broadcast(communicator, reason);
  }


  FileLock::~FileLock()
  {
    if (file >= 0)
      ::close(file);
  }


  bool
  FileLock::open(const std::string &name, const int mode)
  {
    file = ::open(name.c_str(), O_RDWR | O_CLOEXEC | mode, 0666);
    return ::flock(file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
  }


  bool
  FileLock::take(const std::string &name)
  {
    return open(name, O_CREAT);
  }


  bool
  FileLock::is_taken(const std::string &name)
  {
    FileLock lock;
    return !lock.open(name, 0);
  }


  void
  GrowingFile::open(const std::string &name, const std::uintmax_t keep)
  {
    file_name     = name;
    written       = keep;
    serial_number = keep > 0 ? serial_number_of(name) : 0;
  }


  const std::string &
  GrowingFile::name() const
  {
    return file_name;
  }


  std::uintmax_t
  GrowingFile::size() const
  {
    return written;
  }


  void
  GrowingFile::append(const std::string &text)
  {
    waiting += text;
  }


  std::string
  GrowingFile::flush()
  {
    if (written == 0 && waiting.empty())
      return ""; // there is no file yet
    if (const std::string reason = loss(); !reason.empty())
      return reason;
    const std::string reason = put(file_name, waiting, written);
    if (reason.empty())
      {
        written += waiting.size();
        waiting.clear();
        serial_number = serial_number_of(file_name);
      }
    return reason;
  }


  std::string
  GrowingFile::loss() const
  {
    struct stat now;
    if (written == 0)
      return "";
    if (::stat(file_name.c_str(), &now) != 0)
      return errno == ENOENT || errno == ENOTDIR ? removed_meanwhile :
                                                   reason_of(errno);
    if (!S_ISREG(now.st_mode)) // devices keep nothing
      return "";
    const auto size = static_cast<std::uintmax_t>(now.st_size);
    // some network file systems change the inode number of a file
    if (now.st_ino != serial_number && size != written)
      return "another file was put in its place while the run went on";
    return size < written ? "it was cut off while the run went on" : "";
  }


  bool
  GrowingFile::has_waiting() const
  {
    return !waiting.empty();
  }
} // namespace Voussoir
