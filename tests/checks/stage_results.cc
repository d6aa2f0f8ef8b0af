#include <voussoir/fem/nodal_values.h>

#include "csv_table.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A column of height H that settles by its weight and then by a pressure p
     * on its top: at height z by rho g z (H - z / 2) / E and p z / E; and the
     * line of histories.csv of a run that takes no steps.
     */
    class StageResults : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        constexpr double E = 1e9, rho = 2000., g = 9.81, H = 10., p = 3e5;
        const auto       parameters = make_case(file);
        const auto       simulation =
          make_simulation_with_files(*parameters, communicator);
        simulation->run.march();
        const std::string    folder  = parameters->output.folder;
        const nlohmann::json summary = read_summary(folder);
        const nlohmann::json stages  = summary.at("static state").at("stages");
        const double         of_weight = rho * g * H * H / (2. * E),
                     of_both           = of_weight + p * H / E;
        verdicts.near("top after the weight [m]",
                      stages.at(0).at("points").at("top").at(
                        "displacement z [m]"),
                      -of_weight,
                      1e-6);
        verdicts.near("  half way up",
                      stages.at(0).at("points").at("middle").at(
                        "displacement z [m]"),
                      -0.75 * of_weight,
                      1e-6);
        verdicts.near(
          "height of the largest displacement [m]",
          stages.at(1).at("place of the largest displacement [m]").at(2),
          H,
          1e-12);
        verdicts.near("  its z component [m]",
                      stages.at(1).at("largest displacement x, y, z [m]").at(2),
                      -of_both,
                      1e-6);
        const CsvTable table(folder + "/static_stages.csv");
        verdicts.is_true("static_stages.csv: two lines of these names",
                         table.texts("stage") ==
                           std::vector<std::string>({"weight", "pressure"}));
        verdicts.near("  top after both [m]",
                      table.numbers("top displacement z [m]").at(1),
                      -of_both,
                      1e-6);
        verdicts.near("  reactions [MN]",
                      table.numbers("reactions z [MN]").at(1),
                      1e-6 * (rho * g * H + p),
                      1e-6);
        const CsvTable history(folder + "/histories.csv");
        verdicts.is_true("histories.csv: one line, of the static state",
                         history.numbers("time [s]") ==
                             std::vector<double>({0.}) &&
                           history.numbers("top velocity z [m/s]").at(0) == 0.);
        verdicts.near("  top [m]",
                      history.numbers("top displacement z [m]").at(0),
                      -of_both,
                      1e-6);
        verdicts.near(
          "  in the summary [m]",
          summary.at("histories").at("top").at("largest displacement [m]"),
          of_both,
          1e-6);
        verdicts.is_true(
          "static_stages.vtu is there",
          std::ifstream(folder + "/static_stages.vtu").is_open());
        const auto largest = [&](const std::string  &name,
                                 const InitialState &initial) {
          verdicts.near(name + ": after the weight [m]",
                        largest_amount(initial.stages.at(0).second),
                        of_weight,
                        1e-6);
          verdicts.near("  after both [m]",
                        largest_amount(initial.stages.at(1).second),
                        of_both,
                        1e-6);
        };
        largest("pictures", simulation->static_state.initial);
        const auto of_histories = make_case(
          file.with({"Static state/Points=", "Output/Folder=stage_points"}));
        make_simulation_with_files(*of_histories, communicator)->run.march();
        verdicts.near("points of the histories where none are given: top [m]",
                      read_summary("stage_points")
                        .at("static state")
                        .at("stages")
                        .at(0)
                        .at("points")
                        .at("top")
                        .at("displacement z [m]"),
                      -of_weight,
                      1e-6);
        const auto keeping =
          make_case(file.with({"Static state/Keep in=kept_stages",
                               "Output/Folder=stage_results_kept"}));
        make_simulation_with_files(*keeping, communicator);
        largest("pictures of a kept state",
                make_simulation_with_files(*keeping, communicator)
                  ->static_state.initial);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<StageResults>
      registered("stage results", "Results of static stages of a column.");
  } // namespace
} // namespace Voussoir
