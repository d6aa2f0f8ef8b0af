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
   * a list are named by their index, from 0. Of several numbers that fit the
   * largest counts, or the smallest if the last name begins with that word.
   */
  class SummaryNumber
  {
  public:
    explicit SummaryNumber(const std::string &path);

    /** None if nothing fits that is a number. */
    std::optional<double>
    in(const nlohmann::json &summary) const;

    /** A number with its place. */
    struct Found
    {
      double                   value;
      std::vector<std::string> names; // along the path, without stars

      /** When [s] and where [m] that was, if the summary has it beside it:
       *  "time of the smallest safety [s]" beside "smallest safety", or "at the
       *  time [s]", which is that of "largest ..." and "smallest ..." where the
       *  object has such; likewise "place of the ..." and "at [m]". Else null.
       */
      nlohmann::json time, place;
    };

    std::optional<Found>
    find(const nlohmann::json &summary) const;

    /** The smallest or largest of those that fit, whatever it is called. */
    std::optional<Found>
    find(const nlohmann::json &summary, const bool smallest) const;

    /** Whether anything fits, be it a number or null for one that is not
     *  finite. */
    bool
    is_in(const nlohmann::json &summary) const;

    const std::string path;

  private:
    std::vector<std::string> names; // along the path
  };

  /** Whether a name is that of a pattern, in which a star stands for any
   *  letters. */
  bool
  fits(const std::string_view name, const std::string_view pattern);

  /** Whether of several numbers of a path the smallest counts. */
  bool
  is_smallest(const std::string &path);

  /** As many digits as studies write where small changes are to be seen. */
  constexpr int fine_digits = 12;

  /** With six digits, as studies write numbers, or others. */
  std::string
  number_text(const double value, const int digits = 6);

  /** Whether something has happened in a run: "PATH > VALUE" or "PATH < VALUE"
   *  of a number of the summary, or "stopped", see RunStopped. */
  class Criterion
  {
  public:
    /** Throws UserError, which names the place, if it is none of these. */
    Criterion(const std::string &text, const std::string &place);

    /** The number in the criterion, or null. */
    const SummaryNumber *
    about() const;

    /** The number, if the criterion has one, and whether it meets the
     *  criterion. A run that was stopped meets criteria that were met before.
     *  Throws UserError if a run that went to its end does not have the number.
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
   *  any, or lacks their numbers, so that nobody knows. */
  std::optional<std::vector<std::string>>
  met_criteria(const std::vector<Criterion> &criteria,
               const RunSummary             &summary);
} // namespace Voussoir

#endif
