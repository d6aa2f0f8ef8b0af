#ifndef voussoir_base_log_h
#define voussoir_base_log_h

#include <deal.II/base/mpi.h>

#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

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

    MPI_Comm
    communicator() const;

  private:
    MPI_Comm      mpi_communicator;
    const bool    speaks, quiet;
    std::ofstream file;
    std::string   said_before_open;
  };

  /** "1 h 05 min", "3 min 20 s", "12 s". */
  std::string
  duration_text(const double seconds);
} // namespace Voussoir

#endif
