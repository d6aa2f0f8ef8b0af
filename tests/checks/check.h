#ifndef voussoir_tests_check_h
#define voussoir_tests_check_h

#include <voussoir/driver/simulation.h>

#include <iosfwd>

namespace Voussoir
{
  /**
   * The lines a test prints: one quantity each, with its reference and a
   * verdict. Values are rounded to four digits, so that the reference output is
   * valid on other processors.
   */
  class Verdicts
  {
  public:
    explicit Verdicts(const MPI_Comm communicator);

    /** |value/reference - 1| <= tolerance. */
    void
    near(const std::string &name,
         const double       value,
         const double       reference,
         const double       tolerance,
         const std::string &unit = "");

    /** |value| <= limit; prints the limit only, for values near round-off. */
    void
    below(const std::string &name, const double value, const double limit);

    /** value >= limit; prints the limit only, as the digits of a bounded value
     *  are no reference. */
    void
    above(const std::string &name, const double value, const double limit);

    /** A yes-or-no question. */
    void
    is_true(const std::string &name, const bool value);

    /** A text beside the expected one. */
    void
    same_text(const std::string &name,
              const std::string &text,
              const std::string &expected);

    /** A heading for the lines below; no verdict. */
    void
    heading(const std::string &text);

    /** Whether a line printed by the first rank is WRONG. */
    bool
    any_wrong() const;

  private:
    void
    print(const std::string &text, const bool good);

    const MPI_Comm communicator;
    const bool     speaks;
    bool           all_good = true;
  };

  /** Takes the value if it is larger; a NaN stays. */
  template <typename Number>
  void
  keep_largest(Number &largest, const std::remove_reference_t<Number> &value)
  {
    if (!(value <= largest) && !std::isnan(largest))
      largest = value;
  }


  /** Takes the value if it is smaller; a NaN stays. */
  template <typename Number>
  void
  keep_smallest(Number &smallest, const std::remove_reference_t<Number> &value)
  {
    if (!(value >= smallest) && !std::isnan(smallest))
      smallest = value;
  }


  /** Zero for a value below; a NaN stays. */
  inline double
  positive_part(const double value)
  {
    return value <= 0. ? 0. : value;
  }


  /** Largest amount of an entry on all ranks, or NaN if an entry is NaN: the
   *  norms of deal.II ignore NaN. */
  double
  largest_entry(const Vector &vector);

  /**
   * A test: a parameter file in tests/ names it in its section "Check" and the
   * rest of that file is the case that is tested.
   */
  class Check
  {
  public:
    virtual ~Check() = default;

    /** Entries of the section "Check". */
    virtual void
    declare_parameters(dealii::ParameterHandler &)
    {}

    /** @p file makes as many cases as the check needs (see `make_case`). */
    virtual void
    run(const ParameterFile &file,
        Verdicts            &verdicts,
        const MPI_Comm       communicator) = 0;
  };

  /** The case of a test's parameter file, with some entries changed. */
  std::unique_ptr<Case>
  make_case(const ParameterFile &file);

  /** A silent simulation without output folder. */
  std::unique_ptr<Simulation>
  make_simulation(const Case &parameters, const MPI_Comm communicator);
} // namespace Voussoir

#endif
