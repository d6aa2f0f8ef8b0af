#ifndef voussoir_output_table_h
#define voussoir_output_table_h

#include <deal.II/base/mpi.h>

#include <fstream>
#include <string>
#include <vector>

namespace Voussoir
{
  /** A file of comma-separated values over time, with the time in the first
   *  column. The first rank writes it, what the others say is ignored. */
  class TimeTable
  {
  public:
    /**
     * @param columns    titles with units, without that of the time
     * @param start_time of a run that goes on: lines from here on come again
     */
    void
    open(const MPI_Comm                  communicator,
         const std::string              &filename,
         const std::vector<std::string> &columns,
         const double                    time_step,
         const double                    start_time,
         const bool                      restarted);

    void
    write(const double time, const std::vector<double> &values);

    void
    flush();

  private:
    std::ofstream file;
  };
} // namespace Voussoir

#endif
