#include <voussoir/base/parameter_file.h>

#include <filesystem>

#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A shipped case, coarsened: its summary shows what the "Expected:" in its
     *  head says. */
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
        prm.add_parameter("Results",
                          results,
                          "\"place in the summary: smallest: largest\" "
                          "separated by \";\", where the place is a JSON "
                          "pointer.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const std::string folder = "shipped_" + name;
        auto              list   = split_list(changes, ';');
        list.push_back("Output/Folder=" +
                       (std::filesystem::current_path() / folder).string());
        const ParameterFile shipped(file.folder() + "/../../prm/" + name +
                                      ".prm",
                                    list);
        Case                parameters(shipped);
        make_simulation_with_files(parameters, communicator)->run.march();

        const nlohmann::json summary = read_summary(folder);
        verdicts.is_true("no objection to the run",
                         summary.at("verdict") == "no objection");
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
      }

    private:
      std::string name, changes, results;
    };

    const Registry<Check>::Add<ShippedCase>
      registered("shipped case", "A case of prm/ shows what it promises.");
  } // namespace
} // namespace Voussoir
