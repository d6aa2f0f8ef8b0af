#ifndef voussoir_driver_summary_numbers_h
#define voussoir_driver_summary_numbers_h

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace Voussoir
{
  struct RunSummary;

  /**
   * A number of summary.json by its path, as "histories/crest/largest
   * displacement [m]"; a star in a name stands for any letters, and elements of
   * a list are named by their index, from 0. Of several matching numbers the
   * largest counts, or the smallest if the last name begins with "smallest".
   */
  class SummaryNumber
  {
  public:
    explicit SummaryNumber(const std::string &path);

    /** The number; none if no number matches. */
    std::optional<double>
    in(const nlohmann::json &summary) const;

    /** A number with its place. */
    struct Found
    {
      double                   value;
      std::vector<std::string> names; // along the path, without stars

      /** Time [s] and place [m] of the number, if the summary has them beside
       *  it: "time of the smallest safety [s]" beside "smallest safety", or "at
       *  the time [s]", which belongs to "largest ..." and "smallest ..." where
       *  the object has such numbers; likewise "place of the ..." and "at [m]".
       *  Else null. */
      nlohmann::json time, place;
    };

    std::optional<Found>
    find(const nlohmann::json &summary) const;

    /** The smallest or largest of the matching numbers, whatever its name. */
    std::optional<Found>
    find(const nlohmann::json &summary, const bool smallest) const;

    /** Whether anything matches, a number or the null of one that is not
     *  finite. */
    bool
    is_in(const nlohmann::json &summary) const;

    const std::string path;

  private:
    std::vector<std::string> names; // along the path
  };

  /** Numbers with the entries that name them, as the texts of errors do. */
  using NamedNumbers = std::vector<std::pair<SummaryNumber, std::string>>;

  /** Throws UserError, which names the entry, if a summary lacks a number. */
  void
  check_numbers(const NamedNumbers &wanted, const nlohmann::json &summary);

  /** Whether a name matches a pattern, in which a star stands for any letters.
   */
  bool
  fits(const std::string_view name, const std::string_view pattern);

  /** Whether of several numbers of a path the smallest counts. */
  bool
  is_smallest(const std::string &path);

  /** Digits that studies write where small changes matter. */
  constexpr int fine_digits = 12;

  /** A number as text, by default with six digits, as in studies. */
  std::string
  number_text(const double value, const int digits = 6);

  /** A condition on the outcome of a run: "PATH > VALUE" or "PATH < VALUE" of a
   *  number of the summary, or "stopped", see RunStopped. */
  class Criterion
  {
  public:
    /** Throws UserError, which names the place, if the text is none of these.
     */
    Criterion(const std::string &text, const std::string &place);

    /** The number in the criterion, or null. */
    const SummaryNumber *
    about() const;

    /** The number, if the criterion has one, and whether it meets the
     *  criterion. A stopped run meets criteria that were met before its stop.
     *  Throws UserError if a run that reached its end does not have the number.
     */
    std::pair<std::optional<double>, bool>
    evaluate(const RunSummary &summary) const;

    const std::string text;

  private:
    std::optional<SummaryNumber> number; // none: "stopped"
    bool                         above = true;
    double                       limit = 0.;
  };

  /** The criteria that a run meets. None: it failed, was stopped before it met
   *  any, or lacks their numbers, so that the answer is unknown. */
  std::optional<std::vector<std::string>>
  met_criteria(const std::vector<Criterion> &criteria,
               const RunSummary             &summary);
} // namespace Voussoir

#endif
