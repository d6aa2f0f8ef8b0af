#include "csv_table.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A column of height H between smooth walls under its weight, a pressure p
     * on its top and a cooling by T:
     *   sigma_z = -p - rho g (H - z) ,
     *   sigma_x = sigma_y = nu / (1 - nu) sigma_z + a E alpha T / (1 - nu)
     * with the static factor a. On a wall the arch stress is sigma_x, the
     * cantilever stress sigma_z.
     */
    class StageStresses : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        constexpr double E = 20e9, nu = 0.2, a = 0.6, rho = 2000., g = 9.81,
                         H = 10., p = 3e5, alpha = 1e-5, T = 10.;
        constexpr double weight = 1e-6 * rho * g * H, pressure = 1e-6 * p,
                         cooling = 1e-6 * a * E * alpha * T / (1. - nu),
                         aside = nu / (1. - nu), tolerance = 1e-6;
        const auto parameters = make_case(file);
        make_simulation_with_files(*parameters, communicator)->run.march();
        const std::string    folder  = parameters->output.folder;
        const nlohmann::json summary = read_summary(folder);
        const nlohmann::json stages  = summary.at("static state").at("stages");
        const auto           wall    = [&](const unsigned int stage,
                              const std::string &quantity) {
          return stages.at(stage).at("faces").at("front").at(quantity);
        };
        verdicts.near("weight: smallest cantilever stress [MPa]",
                      wall(0, "smallest cantilever stress [MPa]"),
                      -weight,
                      tolerance);
        verdicts.near("  smallest arch stress",
                      wall(0, "smallest arch stress [MPa]"),
                      -aside * weight,
                      tolerance);
        verdicts.near("  smallest principal stress",
                      wall(0, "smallest principal stress [MPa]"),
                      -weight,
                      tolerance);
        verdicts.is_true(
          "  it is at the foot",
          wall(0, "place of the smallest principal stress [m]").at(2) == 0.);
        verdicts.near("pressure: smallest cantilever stress",
                      wall(1, "smallest cantilever stress [MPa]"),
                      -weight - pressure,
                      tolerance);
        verdicts.near("  largest cantilever stress",
                      wall(1, "largest cantilever stress [MPa]"),
                      -pressure,
                      tolerance);
        verdicts.near("  largest arch stress",
                      wall(1, "largest arch stress [MPa]"),
                      -aside * pressure,
                      tolerance);
        verdicts.near("cooling: largest arch stress",
                      wall(2, "largest arch stress [MPa]"),
                      cooling - aside * pressure,
                      tolerance);
        verdicts.near("  smallest arch stress",
                      wall(2, "smallest arch stress [MPa]"),
                      cooling - aside * (pressure + weight),
                      tolerance);
        verdicts.near("  largest principal stress",
                      wall(2, "largest principal stress [MPa]"),
                      cooling - aside * pressure,
                      tolerance);
        verdicts.near(
          "  it is at the height [m]",
          wall(2, "place of the largest principal stress [m]").at(2),
          H,
          1e-12);
        verdicts.near("  smallest cantilever stress",
                      wall(2, "smallest cantilever stress [MPa]"),
                      -weight - pressure,
                      tolerance);
        const auto point = [&](const unsigned int stage,
                               const std::string &name,
                               const std::string &quantity) {
          return stages.at(stage).at("points").at(name).at(quantity);
        };
        verdicts.near("point in a cell, weight: cantilever stress",
                      point(0, "inside", "cantilever stress [MPa]"),
                      -0.72 * weight,
                      tolerance);
        verdicts.near("  arch stress",
                      point(0, "inside", "arch stress [MPa]"),
                      -0.72 * aside * weight,
                      tolerance);
        verdicts.near("point between two, cooling: largest principal stress",
                      point(2, "between", "largest principal stress [MPa]"),
                      cooling - aside * (pressure + 0.6 * weight),
                      tolerance);
        verdicts.near("  smallest principal stress",
                      point(2, "between", "smallest principal stress [MPa]"),
                      -pressure - 0.6 * weight,
                      tolerance);
        const nlohmann::json top = stages.at(1).at("faces").at("top");
        verdicts.near("level face: smallest principal stress",
                      top.at("smallest principal stress [MPa]"),
                      -pressure,
                      tolerance);
        verdicts.is_true("  it has no arch stress",
                         !top.contains("largest arch stress [MPa]"));
        verdicts.is_true(
          "the last one by its name",
          summary.at("static state").at("combinations").at("winter") ==
            stages.at(2));
        verdicts.is_true(
          "static_stages.csv: its lines",
          CsvTable(folder + "/static_stages.csv").texts("stage") ==
            std::vector<std::string>({"weight", "usual", "winter"}));
        verdicts.near("static_stages.csv: smallest cantilever stress",
                      CsvTable(folder + "/static_stages.csv")
                        .numbers("front smallest cantilever stress [MPa]")
                        .at(2),
                      -weight - pressure,
                      tolerance);
        verdicts.near("  of the point in a cell",
                      CsvTable(folder + "/static_stages.csv")
                        .numbers("inside cantilever stress [MPa]")
                        .at(2),
                      -0.72 * weight - pressure,
                      tolerance);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<StageStresses>
      registered("stage stresses",
                 "Stresses of static stages on the walls of a column.");
  } // namespace
} // namespace Voussoir
