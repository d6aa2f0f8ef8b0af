#ifndef voussoir_files_table_h
#define voussoir_files_table_h

#include <voussoir/base/log.h>

namespace Voussoir
{
  /** Bytes of the heading of a file and of its first lines whose first number,
   *  the time, is less than this [s]. Later or incomplete lines belong to an
   *  interrupted run. */
  std::uintmax_t
  size_before(const std::string &filename, const double time);

  /** The heading of a file of comma-separated values, or another line of texts.
   *  Texts with a comma, a quotation mark or a line break are quoted after RFC
   *  4180, so that each stays one column. */
  std::string
  csv_heading(const std::vector<std::string> &titles);

  /** A line of such a file, with nine digits; infinite values are empty. */
  std::string
  csv_line(const std::vector<double> &values);

  /** All lines of such a file, heading included, from its columns, which have
   *  the same length. */
  std::string
  csv_of_columns(const std::vector<std::string>         &titles,
                 const std::vector<std::vector<double>> &columns);

  /** A file of comma-separated values over time, with the time in the first
   *  column. The first rank writes it, lines of the others are ignored. Lines
   *  that cannot be written wait until they can. */
  class TimeTable
  {
  public:
    /**
     * Closes the previous file, if there was one.
     *
     * @param log        records what cannot be written; must live as long as
     *   this
     * @param columns    titles with units, without that of the time
     * @param time_step  [s]
     * @param start_time of a run that continues [s]: lines from here on are
     * written again; earlier ones are kept
     */
    void
    open(Log                            &log,
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
    Log                         *log = nullptr;
    std::shared_ptr<GrowingFile> file;
  };
} // namespace Voussoir

#endif
