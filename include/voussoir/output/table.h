#ifndef voussoir_output_table_h
#define voussoir_output_table_h

#include <deal.II/base/mpi.h>

#include <fstream>
#include <string>
#include <vector>

namespace Voussoir
{
  /** The heading of a file of comma-separated values. Titles with a comma, a
   *  quotation mark or a line break are quoted as RFC 4180 has it, so that each
   *  stays one column. */
  std::string
  csv_heading(const std::vector<std::string> &titles);

  /** A line of such a file, with nine digits; infinite values are empty. */
  std::string
  csv_line(const std::vector<double> &values);

  /** A file of comma-separated values over time, with the time in the first
   *  column. The first rank writes it, what the others say is ignored. */
  class TimeTable
  {
  public:
    /**
     * Leaves the file it wrote to before, if there was one.
     *
     * @param columns    titles with units, without that of the time
     * @param time_step  [s]
     * @param start_time of a run that goes on [s]: lines from here on come
     *   again; others are kept
     */
    void
    open(const MPI_Comm                  communicator,
         const std::string              &filename,
         const std::vector<std::string> &columns,
         const double                    time_step,
         const double                    start_time,
         const bool                      restarted);

    /** @param time [s]; @p values one for each column. */
    void
    write(const double time, const std::vector<double> &values);

    void
    flush();

  private:
    std::ofstream file;
  };
} // namespace Voussoir

#endif
