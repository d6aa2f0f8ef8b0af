#ifndef voussoir_driver_study_statistics_h
#define voussoir_driver_study_statistics_h

#include <voussoir/driver/study_parameters.h>

namespace Voussoir
{
  /** Values of one quantity in several runs; none where a run ended early. */
  using Sample = std::vector<std::optional<double>>;

  /** Mean and spread of a sample, and the values that 16, 50 and 84 % of the
   *  runs do not exceed. */
  struct Statistics
  {
    /**
     * @param beyond value of the runs without one, plus or minus infinity: they
     *   count for the fractiles, not for mean and deviation
     */
    Statistics(const Sample &sample, const double beyond);

    unsigned int                         n = 0;           // with a value
    std::optional<double>                mean, deviation; // of the population
    std::array<std::optional<double>, 3> fractiles;       // none: beyond
  };

  /** A run, or the search for a limit, of a study. */
  struct StudySample
  {
    StudyValues values;
    Sample      quantities;
  };

  /**
   * A table of the statistics over some varied entries, a line for each
   * combination of the others and each quantity.
   *
   * @param spread_entries entries over which statistics are taken
   * @param names          of the quantities
   */
  std::string
  statistics_table(const std::vector<StudySample> &samples,
                   const std::vector<std::string> &spread_entries,
                   const std::vector<std::string> &names);
} // namespace Voussoir

#endif
