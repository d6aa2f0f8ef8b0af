#ifndef voussoir_output_table_observer_h
#define voussoir_output_table_observer_h

#include <voussoir/base/sum.h>
#include <voussoir/files/table.h>
#include <voussoir/output/observer.h>

namespace Voussoir
{
  /**
   * An observer with a table over time: the entry "Interval", lines at that
   * interval, and samples between them for extremes. Samples are collected, so
   * that the ranks exchange a hundred of them at once.
   */
  class TableObserver : public Observer
  {
  protected:
    /** Values of one moment. */
    struct Sample
    {
      double              time;      // [s]
      bool                has_line;  // in the table
      std::vector<Sum>    parts;     // of this rank
      std::vector<double> largest;   // values of a rank; later the largest
      std::vector<double> sums = {}; // of the parts of all ranks, later
    };

    /**
     * @param filename in the output folder
     * @param interval default of the entry [s]
     */
    TableObserver(const std::string &filename, const double interval);

    /** Adds the entry "Interval". */
    void
    declare_interval(dealii::ParameterHandler &prm,
                     const std::string        &description);

    /** Begins the table, in prepare().
     *  @param columns titles with units, without that of the time */
    void
    open_table(const std::vector<std::string> &columns);

    /** Whether a line is due at a step. */
    bool
    has_line(const unsigned long long step) const;

    /** Whether a line or a sample for extremes is due. */
    bool
    is_due(const unsigned long long step) const;

    /** A number of empty sums, exact where results are reproducible. */
    std::vector<Sum>
    no_sums(const std::size_t n) const;

    /** Adds a sample. All ranks call this together, with lists that are equally
     *  long in each sample. */
    void
    take(Sample &&sample);

    /** The line of a sample, in the order of the columns, once its sums and
     *  largest values are those of all ranks; overrides find extremes here. By
     *  default the line has the sums. */
    virtual std::vector<double>
    line_of(const Sample &sample);

    void
    flush() override;

    /** Largest and smallest values of the columns of the table. */
    struct Extremes
    {
      std::vector<double> largest, smallest;

      void
      take(const std::vector<double> &line);
    };

    /** Initializes the extremes for a number of columns. */
    void
    keep(Extremes &extremes, const std::size_t n_columns);

    using Observer::keep;

    double    interval; // [s]
    TimeTable table;

  private:
    const std::string   filename;
    Schedule            lines, samples;
    std::vector<Sample> waiting;
  };
} // namespace Voussoir

#endif
