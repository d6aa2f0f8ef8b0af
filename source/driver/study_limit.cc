#include <voussoir/base/error.h>
#include <voussoir/driver/study.h>

namespace Voussoir
{
  bool
  Study::is_met(StudyValues values, const double value)
  {
    values.emplace_back(parameters.varied_to_limit,
                        number_text(value, fine_digits));
    const Outcome     outcome = outcome_of(values);
    const RunSummary &summary = outcome.summary;
    const std::string where =
      "At " + parameters.varied_to_limit + " = " + number_text(value) + " ";
    if (summary.end == RunEnd::failed)
      throw UserError(where + "the run in \"" + outcome.folder + "\" " +
                      summary.short_verdict() +
                      ", so that the criterion of section \"Study/Limit\" "
                      "cannot be evaluated; correct that and start the study "
                      "again.");
    for (const Criterion &criterion : parameters.criteria())
      {
        const auto [number, met] = criterion.evaluate(summary);
        if (met)
          {
            report(
              "  met: " + criterion.text +
              (number ? " (" + number_text(*number) + ")" : std::string()));
            return true;
          }
      }
    if (summary.end == RunEnd::stopped)
      throw UserError(
        where + "the run in \"" + outcome.folder + "\" was " +
        summary.short_verdict() +
        ", before the criterion of section \"Study/Limit\" was met; whether "
        "it would have been met is unknown: add \"; stopped\" to the "
        "criterion if that counts as failure.");
    return false;
  }


  void
  Study::seek_limit(const StudyValues &values)
  {
    constexpr unsigned int max_extensions = 4;
    const double           span           = parameters.to - parameters.from;
    Limit                  limit{values, parameters.from, parameters.to};
    const auto             refuse = [&](const double value, const char *how) {
      throw UserError(
        "At " + parameters.varied_to_limit + " = " + number_text(value) +
        " the criterion of section "
                    "\"Study/Limit\" is " +
        how + "; give another \"From\" or \"To\"" +
        (parameters.extend ? "." : ", or set \"Extend = true\"."));
    };
    for (unsigned int i = 0; is_met(values, limit.fails); ++i)
      {
        if (!parameters.extend || i == max_extensions)
          refuse(limit.fails, "met already");
        limit.meets = limit.fails;
        // values that begin above zero stay positive
        limit.fails = limit.fails > 0. && limit.fails <= span ?
                        0.5 * limit.fails :
                        limit.fails - span;
      }
    for (unsigned int i = 0;
         limit.fails >= parameters.from && limit.meets >= parameters.to &&
         !is_met(values, limit.meets);
         ++i)
      {
        if (!parameters.extend || i == max_extensions)
          refuse(limit.meets, "not met yet");
        limit.fails = limit.meets;
        limit.meets += span;
      }
    while (limit.meets - limit.fails > parameters.accuracy * (1. + 1e-9))
      {
        const double middle = 0.5 * (limit.fails + limit.meets);
        (is_met(values, middle) ? limit.meets : limit.fails) = middle;
      }
    report((values.empty() ? std::string() : description(values) + ": ") +
           "limit of " + parameters.varied_to_limit + " between " +
           number_text(limit.fails) + " and " + number_text(limit.meets));
    limits.push_back(limit);
  }
} // namespace Voussoir
