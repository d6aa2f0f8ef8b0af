#include <voussoir/base/text.h>

#include <cmath>
#include <limits>

#include "csv_table.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** When a column of a table is above a value for the first time [s]. */
    double
    first_time_above(const CsvTable    &table,
                     const std::string &column,
                     const double       value)
    {
      const auto times  = table.numbers("time [s]"),
                 values = table.numbers(column);
      for (std::size_t i = 0; i < times.size(); ++i)
        if (values[i] > value)
          return times[i];
      return std::numeric_limits<double>::infinity();
    }


    /** A shipped case, coarsened: its summary and the order of its events agree
     *  with "Expected:" in its head. */
    class ShippedCase : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Case", name, "Name of a file in prm/.");
        prm.add_parameter("Changes",
                          changes,
                          "\"Section/Entry=value\", separated by \";\".");
        prm.add_parameter("Warnings",
                          warnings,
                          "Parts of the warnings that the run must give, one "
                          "after the other and no more, separated by \"|\"; "
                          "empty: none.");
        prm.add_parameter(
          "Not met",
          not_met_lines,
          "Lines of the tables of the verdict that the run does "
          "not meet, separated by \"; \", but for the frequency "
          "that its mesh carries.");
        prm.add_parameter("Results",
                          results,
                          "\"place in the summary: smallest: largest\" "
                          "separated by \";\", where the place is a JSON "
                          "pointer.");
        prm.add_parameter("Events",
                          events,
                          "\"file: column: value\" separated by \";\": the "
                          "columns rise above their values one after the "
                          "other.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const std::string folder = "shipped_" + name;
        Case              parameters(shipped_file(file, name, changes, folder));
        make_simulation_with_files(parameters, communicator)->run.march();

        const nlohmann::json summary = read_summary(folder);
        check_warnings(summary, verdicts);
        for (const std::string &result : split_list(results, ';'))
          {
            const auto   parts = split_list(result, ':');
            const double value =
              summary.at(nlohmann::json::json_pointer(parts.at(0)));
            const double smallest = std::stod(parts.at(1)),
                         largest  = std::stod(parts.at(2));
            std::ostringstream text;
            text << parts[0] << " between " << smallest << " and " << largest;
            if (!(value >= smallest && value <= largest))
              text << ": it is " << value;
            verdicts.is_true(text.str(), value >= smallest && value <= largest);
          }
        check_order(folder, verdicts);
      }

    private:
      void
      check_warnings(const nlohmann::json &summary, Verdicts &verdicts) const
      {
        const auto                     expected = split_list(warnings, '|');
        const std::vector<std::string> said     = summary.at("warnings");
        for (std::size_t i = 0; i < said.size(); ++i)
          verdicts.is_true("warning: " +
                             (i < expected.size() ? expected[i] : said[i]),
                           i < expected.size() &&
                             said[i].find(expected[i]) != std::string::npos);
        if (expected.empty())
          verdicts.is_true("no warnings", said.empty());
        else
          verdicts.is_true("these warnings and no more",
                           said.size() == expected.size());
        // its mesh is coarsened, so that its carried frequency is not compared
        std::string       verdict = summary.at("verdict");
        const std::string coarse  = "frequency that the mesh carries [Hz]";
        std::vector<std::string> lines;
        for (const char *table :
             {"numerical checks", "engineering results", "acceptance table"})
          if (summary.contains(table))
            for (const std::string &line : not_met(summary.at(table)))
              if (line != coarse)
                lines.push_back(line);
        verdicts.same_text("not met", join(lines, "; "), not_met_lines);
        verdicts.is_true("  as the verdict says",
                         (verdict.rfind("not met: ", 0) == 0) ==
                           (!lines.empty() ||
                            verdict.find(coarse) != std::string::npos));
      }

      void
      check_order(const std::string &folder, Verdicts &verdicts) const
      {
        double previous = 0.;
        for (const std::string &event : split_list(events, ';'))
          {
            const auto   parts = split_list(event, ':');
            const double time =
              first_time_above(CsvTable(folder + '/' + parts.at(0)),
                               parts.at(1),
                               std::stod(parts.at(2)));
            std::ostringstream text;
            text << parts[1] << " above " << parts[2];
            const bool in_order = std::isfinite(time) && time >= previous;
            if (!in_order)
              text << " at " << time << " s, the event before it at "
                   << previous << " s";
            verdicts.is_true(text.str(), in_order);
            previous = time;
          }
      }

      std::string name, changes, warnings, not_met_lines, results, events;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<ShippedCase>
      registered("shipped case", "A case of prm/ gives its expected results.");
  } // namespace
} // namespace Voussoir
