#ifndef voussoir_driver_study_parameters_h
#define voussoir_driver_study_parameters_h

#include <voussoir/driver/summary_numbers.h>

#include <deal.II/base/parameter_handler.h>

#include <utility>

namespace Voussoir
{
  /** Entries and their values in one run of a study, as they are written. */
  using StudyValues = std::vector<std::pair<std::string, std::string>>;

  /** The name by which a study calls the number that divides strengths. */
  inline const std::string strength_reduction = "strength reduction";

  /** The entries of the section "Study". */
  struct StudyParameters
  {
    std::string  vary, spread, reduced, quantities;
    unsigned int ranks_of_run = 0;

    // of the search for a limit
    std::string varied_to_limit, criterion;
    double      from = 1., to = 2., accuracy = 0.05;
    bool        extend = true;

    void
    declare(dealii::ParameterHandler &prm);

    /** Whether there is anything to study. */
    bool
    wanted() const;

    bool
    seeks_limit() const;

    /** Whether strengths are divided in some of the runs. */
    bool
    reduces_strengths() const;

    /** Refuses lists of no values or of unequal length, and criteria that are
     *  none. */
    void
    check() const;

    /** The values of each run, or of each search for a limit; one without any
     *  if nothing is varied. */
    std::vector<StudyValues>
    combinations() const;

    /** Entries over which statistics are computed, with their partners. */
    std::vector<std::string>
    spread_entries() const;

    std::vector<SummaryNumber>
    numbers() const;

    std::vector<Criterion>
    criteria() const;
  };
} // namespace Voussoir

#endif
