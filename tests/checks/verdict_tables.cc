#include <voussoir/driver/verdict_tables.h>
#include <voussoir/signals/fourier.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Acceptance table, engineering results and verdict of invented summaries
     * whose verdicts are known; and the frequency of the intensity of two
     * sines.
     */
    class VerdictTables : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        const auto parameters = make_case(file);
        criteria(parameters->acceptance, verdicts);
        results(parameters->acceptance, verdicts);
        observers(file, verdicts);
        intensity(verdicts);
      }

    private:
      static RunSummary
      judged(const AcceptanceParameters &acceptance,
             const nlohmann::json       &observers)
      {
        RunSummary summary;
        summary.observers = observers;
        summary.judge(acceptance);
        return summary;
      }


      static void
      criteria(const AcceptanceParameters &acceptance, Verdicts &verdicts)
      {
        const nlohmann::json observers{
          {"histories",
           {{"crest",
             {{"largest displacement [m]", 0.2},
              {"time of the largest displacement [s]", 3.5}}},
            {"base", {{"largest displacement [m]", 0.1}}}}},
          {"through cracks",
           {{"largest opening from face to face at one moment [mm]", 64.},
            {"at the time [s]", 2.},
            {"opening from face to face at the end [mm]", 12.},
            {"time of the opening from face to face at the end [s]", 9.}}},
          {"detachment", {{"crack over its cell", 0.1}, {"at [m]", {1, 2, 3}}}},
          {"tension",
           {{"largest principal stress [MPa]", 3.},
            {"at the time [s]", 2.},
            {"not exceeded in 95 % of the volume [MPa]", 1.}}},
          {"interfaces",
           {{"surfaces", nlohmann::json::object()},
            {"blocks",
             {{"left",
               {{"smallest safety", 1.4},
                {"time of the smallest safety [s]", 2.},
                {"slip at the end [mm]", 0.},
                {"slip rate at the end [mm/s]", 0.}}}}}}}};
        const RunSummary      summary = judged(acceptance, observers);
        const nlohmann::json &crest   = summary.acceptance.at("crest");
        verdicts.is_true("0.2 at most 0.15: not met", crest.at("met") == false);
        verdicts.near("  demand", crest.at("demand"), 0.2, 1e-12);
        verdicts.same_text("  of",
                           crest.at("of"),
                           "histories/crest/largest displacement [m]");
        verdicts.near("  when [s]", crest.at("at the time [s]"), 3.5, 1e-12);
        verdicts.same_text("  clause", crest.at("clause"), "4.2");
        verdicts.same_text("  load case", crest.at("load case"), "MCE");
        verdicts.is_true("1.4 at least 1.3: met",
                         summary.acceptance.at("block").at("met") == true);
        verdicts.near("  when [s]",
                      summary.acceptance.at("block").at("at the time [s]"),
                      2.,
                      1e-12);
        verdicts.is_true("no such number: not assessed",
                         summary.acceptance.at("rate").at("met").is_null());
        const auto time_of = [&summary](const char *name) {
          const nlohmann::json &line = summary.acceptance.at(name);
          return line.contains("at the time [s]") ?
                   line.at("at the time [s]").get<double>() :
                   -1.;
        };
        verdicts.near("cut through, when it was widest [s]",
                      time_of("cut through"),
                      2.,
                      1e-12);
        verdicts.near("  at the end [s]",
                      time_of("open at the end"),
                      9.,
                      1e-12);
        verdicts.near("  a share of the volume has no time",
                      time_of("most of the volume"),
                      -1.,
                      0.);
        verdicts.is_true("  a crack that is no extreme has the place beside it",
                         summary.acceptance.at("loose").at("at [m]") ==
                           nlohmann::json({1, 2, 3}));
        verdicts.is_true("a criterion of another load case is left out",
                         !summary.acceptance.contains("other case"));
        verdicts.same_text(
          "verdict",
          summary.verdict(),
          "not met: detached: crack over its cell; open from face to face "
          "at one moment [mm]; open from face to face at the "
          "end [mm]; crest; cut through; loose; open at the end");
        const RunSummary read = nlohmann::json(summary).get<RunSummary>();
        verdicts.is_true("read as it was written",
                         read.acceptance == summary.acceptance &&
                           read.results == summary.results &&
                           read.verdict() == summary.verdict());
      }


      static void
      results(const AcceptanceParameters &, Verdicts &verdicts)
      {
        const AcceptanceParameters none;
        const auto                 verdict = [&](const nlohmann::json &found) {
          return judged(none, found).verdict();
        };
        const auto over = [](const double ratio, const double at_rest) {
          return nlohmann::json(
            {{"over-stress",
              {{"verdict", "linear analysis suffices"},
               {"upstream face",
                {{"largest ratio", ratio},
                 {"largest ratio at rest", at_rest},
                 {"time of the largest ratio at rest [s]", 0.},
                 {"place of the largest ratio at rest [m]", {4., 5., 6.}},
                 {"at the time [s]", 2.},
                 {"at [m]", {1., 2., 3.}}}}}}});
        };
        verdicts.same_text("demand below strength",
                           verdict(over(0.9, 0.5)),
                           "no objection");
        verdicts.same_text("demand over strength",
                           verdict(over(3.7, 0.5)),
                           "not met: demand over tensile strength");
        verdicts.is_true("  with its place",
                         judged(none, over(3.7, 0.5))
                             .results.at("demand over tensile strength")
                             .at("at [m]") == nlohmann::json({1., 2., 3.}));
        verdicts.is_true(
          "  that of the static state has its own",
          judged(none, over(3.7, 0.5))
              .results.at("demand over tensile strength in the static state")
              .at("at [m]") == nlohmann::json({4., 5., 6.}));
        verdicts.same_text(
          "a demand that is no number",
          verdict(over(std::numeric_limits<double>::quiet_NaN(), 0.5)),
          "not met: demand over tensile strength");
        const auto through = [](const double once, const double last) {
          return nlohmann::json(
            {{"through cracks",
              {{"largest opening from face to face at one moment [mm]", once},
               {"opening from face to face at the end [mm]", last},
               {"at the time [s]", 2.}}}});
        };
        verdicts.same_text("closed", verdict(through(0., 0.)), "no objection");
        verdicts.same_text(
          "cut through, and closed again",
          verdict(through(64., 0.)),
          "not met: open from face to face at one moment [mm]");
        const auto slid = [](const double slip, const double rate) {
          return nlohmann::json(
            {{"interfaces",
              {{"surfaces",
                {{"plane",
                  {{"residual slip [mm]", slip},
                   {"slip rate at the end [mm/s]", rate}}}}}}}});
        };
        verdicts.same_text("at rest", verdict(slid(0., 0.)), "no objection");
        verdicts.same_text("it slid",
                           verdict(slid(441., 0.)),
                           "to be judged: slip at the end [mm]");
        verdicts.same_text("it slides on",
                           verdict(slid(441., 92.)),
                           "not met: slip rate at the end [mm/s]");
      }


      /** Interfaces are observed for the verdict in any case. */
      static void
      observers(const ParameterFile &file, Verdicts &verdicts)
      {
        const auto observed = [&file](const std::string &active) {
          const auto parameters =
            make_case(file.with({"Interfaces/Names=plane",
                                 "Interfaces/plane/Face sets=top",
                                 "Interfaces/plane/Active=" + active}));
          const auto &added = parameters->added_observers;
          return std::find(added.begin(), added.end(), "interfaces") !=
                 added.end();
        };
        verdicts.is_true("interfaces are observed for the verdict",
                         observed("true"));
        verdicts.is_true("  not those that are left out", !observed("false"));
      }


      // 2 sin of 3 Hz and sin of 8 Hz: four fifths of the intensity below 8 Hz
      static void
      intensity(Verdicts &verdicts)
      {
        std::array<std::vector<double>, 3> motion;
        for (unsigned int i = 0; i < 8192; ++i)
          {
            const double t = i * 1e-3;
            motion[1].push_back(2. * std::sin(2. * numbers::PI * 3. * t) +
                                std::sin(2. * numbers::PI * 8. * t));
          }
        verdicts.near("frequency of 70 % of the intensity [Hz]",
                      frequency_of_intensity(motion, 1e-3, 0.7),
                      3.,
                      0.05);
        verdicts.near("  of 90 %",
                      frequency_of_intensity(motion, 1e-3, 0.9),
                      8.,
                      0.02);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<VerdictTables>
      registered("verdict tables", "Lines under each verdict.");
  } // namespace
} // namespace Voussoir
