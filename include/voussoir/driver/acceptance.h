#ifndef voussoir_driver_acceptance_h
#define voussoir_driver_acceptance_h

#include <voussoir/base/option.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/driver/summary_numbers.h>

#include <list>

namespace Voussoir
{
  enum class LoadCase
  {
    static_usual,
    static_unusual,
    operating_basis,
    maximum_design,
    maximum_credible,
    after_earthquake
  };

  inline OptionNames<LoadCase>
  option_names(const LoadCase)
  {
    return {{LoadCase::static_usual, "static usual"},
            {LoadCase::static_unusual, "static unusual"},
            {LoadCase::operating_basis, "OBE"},
            {LoadCase::maximum_design, "MDE"},
            {LoadCase::maximum_credible, "MCE"},
            {LoadCase::after_earthquake, "after the earthquake"}};
  }


  /** A limit of a number of the summary. */
  struct AcceptanceCriterion
  {
    std::string name, clause, source, quantity, at_most, at_least;
    LoadCase    load_case = LoadCase::maximum_credible;
  };

  /** The entries of the section "Acceptance". */
  class AcceptanceParameters
  {
  public:
    /** Declares a section for each name that the file lists. */
    void
    declare(dealii::ParameterHandler &prm, const ParameterFile &file);

    /** Refuses criteria without quantity, without limit or with both limits. */
    void
    check() const;

    /** Criteria of the load cases of the run. */
    std::vector<AcceptanceCriterion>
    of_the_run() const;

    /**
     * A line for each of them, by its name: clause, load case, quantity,
     * source, "demand", limit as "at most" or "at least", "met", and where the
     * summary has them "of", "at the time [s]", "at [m]". If the summary has no
     * such number, demand and "met" are null: the criterion is not assessed.
     */
    nlohmann::json
    table(const nlohmann::json &summary) const;

  private:
    std::string                    names, load_cases;
    std::list<AcceptanceCriterion> criteria; // whose addresses prm stores
  };

  /** A number beside its limit, as a line of a table: "value", "at most" or "at
   *  least", "met". A number that is not finite is null, and not met. */
  nlohmann::json
  at_most(const double value, const double limit);

  nlohmann::json
  at_least(const double value, const double limit);

  /** A number without a limit: "met" is null, it is to be judged. */
  nlohmann::json
  without_limit(const double value);

  /** Names of the lines of a table that are not met, or are not assessed. */
  std::vector<std::string>
  not_met(const nlohmann::json &table);

  std::vector<std::string>
  not_judged(const nlohmann::json &table);
} // namespace Voussoir

#endif
