#ifndef voussoir_base_log_h
#define voussoir_base_log_h

#include <deal.II/base/mpi.h>

#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace Voussoir
{
  /** What the program says: on the terminal of the first rank and, once the
   *  output folder is known, in its log.txt. */
  class Log
  {
  public:
    explicit Log(const MPI_Comm communicator, const bool quiet = false);

    /** Writes to this file from now on, first what was said before. */
    void
    open(const std::string &filename, const bool append);

    /** Says something; the text brings its own line ends. */
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

    /** Says what the results must not be read without: also if the log is
     *  quiet, and again at the end and in the summary of a run. Warnings that
     *  were said before are not repeated. */
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

    MPI_Comm
    communicator() const;

  private:
    void
    add_warning(const std::string &text);

    MPI_Comm      mpi_communicator;
    const bool    speaks, quiet;
    std::ofstream file;
    std::string   said_before_open;

    std::vector<std::string> all_warnings;
  };

  /** "1 h 05 min", "3 min 20 s", "12 s". */
  std::string
  duration_text(const double seconds);
} // namespace Voussoir

#endif
