#include <voussoir/driver/run_summary.h>
#include <voussoir/driver/study.h>
#include <voussoir/driver/summary_numbers.h>

#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A shipped study, coarsened: its runs agree with "Expected:" in its head.
     */
    class ShippedStudy : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Case", name, "Name of a file in prm/.");
        prm.add_parameter("Changes",
                          changes,
                          "\"Section/Entry=value\", separated by \";\".");
        prm.add_parameter("Limits", n_limits, "Number of limits found.");
        prm.add_parameter("Results",
                          results,
                          "\"run: criterion\" on its summary, as in section "
                          "\"Study/Limit\", separated by \";\"; runs count "
                          "from 0.");
        prm.add_parameter("Orders",
                          orders,
                          "\"run: path of a number > path of a smaller one\", "
                          "separated by \";\".");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const ParameterFile shipped = shipped_file(file, name, changes, name);
        const std::string   folder  = shipped.given("Output/Folder");
        RunOptions          options;
        options.quiet     = true;
        options.overwrite = true;
        Study(shipped, options, communicator).run();
        MPI_Barrier(communicator);

        std::ifstream     in(folder + "/study.json");
        const auto        study = nlohmann::json::parse(in);
        const std::size_t n_found =
          study.value("limits", nlohmann::json::array()).size();
        verdicts.is_true("limits found: " + std::to_string(n_limits),
                         n_found == n_limits);
        const auto summary_of = [&study](const std::string &run) {
          return read_summary(
            study.at("runs").at(std::stoul(run)).at("folder"));
        };
        for (const std::string &result : split_list(results, ';'))
          {
            const auto parts = split_list(result, ':');
            const auto found =
              Criterion(parts.at(1), "Results")
                .evaluate(summary_of(parts.at(0)).get<RunSummary>());
            verdicts.is_true("run " + result +
                               (found.second || !found.first ?
                                  std::string() :
                                  ": it is " + number_text(*found.first)),
                             found.second);
          }
        for (const std::string &order : split_list(orders, ';'))
          {
            const auto parts   = split_list(order, ':');
            const auto paths   = split_list(parts.at(1), '>');
            const auto summary = summary_of(parts.at(0));
            const auto larger  = SummaryNumber(paths.at(0)).in(summary),
                       smaller = SummaryNumber(paths.at(1)).in(summary);
            verdicts.is_true("run " + order, larger && larger > smaller);
          }
      }

    private:
      std::string  name, changes, results, orders;
      unsigned int n_limits = 0;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<ShippedStudy>
      registered("shipped study",
                 "A study of prm/ gives its expected results.");
  } // namespace
} // namespace Voussoir
