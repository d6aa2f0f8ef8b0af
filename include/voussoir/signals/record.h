#ifndef voussoir_signals_record_h
#define voussoir_signals_record_h

#include <voussoir/base/gravity.h>
#include <voussoir/base/option.h>
#include <voussoir/signals/time_series.h>

#include <string>

namespace Voussoir
{
  enum class AccelerationUnit
  {
    g,
    m_per_s2,
    cm_per_s2
  };

  inline OptionNames<AccelerationUnit>
  option_names(const AccelerationUnit)
  {
    return {{AccelerationUnit::g, "g"},
            {AccelerationUnit::m_per_s2, "m/s2"},
            {AccelerationUnit::cm_per_s2, "cm/s2"}};
  }


  /** Properties of an accelerogram that its file does not contain. */
  struct RecordFormat
  {
    AccelerationUnit unit = AccelerationUnit::g;

    /** Time step of a file with a single column [s]; 0 for all other files. */
    double time_step = 0;

    /** The column to take, counted from 1 without the time column. */
    unsigned int column = 1;
  };

  /**
   * Read an accelerogram and return it in m/s2. Two kinds of file are
   * distinguished by their content:
   * - AT2 (PEER): header lines that give NPTS and DT in any of the usual
   *   spellings, then NPTS numbers, any number per line;
   * - columns: times and one or more accelerations, separated by blanks,
   *   commas, semicolons or tabs, or one column of accelerations at the
   *   RecordFormat::time_step. Lines that start with # % ! or // are comments;
   *   lines before the numbers that start with a word are headings.
   *
   * Throws UserError, naming file and line, for whatever is not a complete
   * series of finite numbers at constant time step.
   */
  TimeSeries
  read_record(const std::string &file, const RecordFormat &format);
} // namespace Voussoir

#endif
