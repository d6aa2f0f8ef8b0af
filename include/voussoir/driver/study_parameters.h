#ifndef voussoir_driver_study_parameters_h
#define voussoir_driver_study_parameters_h

#include <voussoir/driver/summary_numbers.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <utility>

namespace Voussoir
{
  /** Entries and their values in one run of a study, as text. */
  using StudyValues = std::vector<std::pair<std::string, std::string>>;

  /** Name, in a study, of the number that divides strengths. */
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

    // of the extrapolation to cells and steps of size zero
    std::string  refined;
    double       method_order = 2.;
    unsigned int dimensions   = 3;

    // of fragility curves
    std::string intensity, fragility_criterion;
    double      confidence = 0.9;

    // of the sensitivity to each number of the file
    double      change = 0.;
    std::string moved  = "*";

    // of the calibration to measured numbers
    std::string  fitted, measured;
    double       measurement_error = 0.01, calibration_accuracy = 1e-3;
    unsigned int max_iterations = 10;

    void
    declare(dealii::ParameterHandler &prm);

    /** Whether there is anything to study. */
    bool
    wanted() const;

    bool
    seeks_limit() const;

    /** Whether each number of the file is moved. */
    bool
    moves_numbers() const;

    /** Whether entries are fitted to measured numbers. */
    bool
    calibrates() const;

    /** Whether strengths are divided in some of the runs. */
    bool
    reduces_strengths() const;

    /** Refuses empty lists, lists of unequal length, and invalid criteria. */
    void
    check() const;

    /** The values of each run, or of each search for a limit; one empty item if
     *  nothing is varied. */
    std::vector<StudyValues>
    combinations() const;

    /** Entries over which statistics are computed, with their partners. */
    std::vector<std::string>
    spread_entries() const;

    /** Entries that make cells or steps smaller, with their partners. */
    std::vector<std::string>
    refined_entries() const;

    /** Entries whose runs are the trials and levels of a fragility curve. */
    std::vector<std::string>
    fragility_entries() const;

    std::vector<SummaryNumber>
    numbers() const;

    std::vector<Criterion>
    criteria() const;

    std::vector<Criterion>
    fragility_criteria() const;

    std::vector<std::string>
    fitted_entries() const;

    /** Numbers of the summary with their measured values. */
    std::vector<std::pair<SummaryNumber, double>>
    measured_numbers() const;

    /** Numbers that entries name. */
    NamedNumbers
    named_numbers() const;

  private:
    void
    declare_limit(dealii::ParameterHandler &prm);

    void
    declare_extrapolation(dealii::ParameterHandler &prm);

    void
    declare_fragility(dealii::ParameterHandler &prm);

    void
    declare_sensitivity(dealii::ParameterHandler &prm);

    void
    declare_calibration(dealii::ParameterHandler &prm);

    /** Refuses fewer numbers than entries, and other evaluations beside
     *  calibration. */
    void
    check_calibration() const;

    /** Refuses entries that exclude extrapolation, fragility or sensitivity. */
    void
    check_evaluations() const;

    /** @param list of varied entries, in the entry @p place */
    std::vector<std::string>
    with_partners(const std::string &list, const std::string &place) const;
  };

  /** "Overload factor = 1.2, Young's modulus = 15e9". */
  std::string
  description(const StudyValues &values);

  /** Values of the entries that are not in a list. */
  StudyValues
  other_values(const StudyValues              &values,
               const std::vector<std::string> &entries);

  /** Runs that differ only in the values of some entries. */
  template <typename Run>
  struct StudyGroup
  {
    StudyValues              others; // of the other entries
    std::vector<const Run *> runs;
  };

  /** All groups, in the order of the runs. */
  template <typename Run>
  std::vector<StudyGroup<Run>>
  grouped(const std::vector<Run> &runs, const std::vector<std::string> &entries)
  {
    std::vector<StudyGroup<Run>> groups;
    for (const Run &run : runs)
      {
        const StudyValues others = other_values(run.values, entries);
        auto              group =
          std::find_if(groups.begin(), groups.end(), [&](const auto &other) {
            return other.others == others;
          });
        if (group == groups.end())
          group = groups.insert(groups.end(), {others, {}});
        group->runs.push_back(&run);
      }
    return groups;
  }
} // namespace Voussoir

#endif
