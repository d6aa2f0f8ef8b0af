#include "csv_table.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Two blocks on a wall, the end of one at a second wall, whose weight acts
     * across the row while they stand free. The joint between them is grouted
     * and tied, and the row pulled by q: it stretches by q L / E as one bar, in
     * spite of a joint with friction and without bond, and remains so in the
     * run.
     */
    class TiedJoint : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        constexpr double E = 1e9, L = 10., q = 2e6;
        const auto       parameters = make_case(file);
        const auto       simulation =
          make_simulation_with_files(*parameters, communicator);
        simulation->run.march();
        const nlohmann::json summary = read_summary(parameters->output.folder);
        const nlohmann::json stages  = summary.at("static state").at("stages");
        const auto           along   = [&](const unsigned int stage,
                               const std::string &point) {
          return stages.at(stage)
            .at("points")
            .at(point)
            .at("displacement z [m]")
            .get<double>();
        };
        verdicts.near("stretched by [mm]",
                      1e3 * (along(1, "end") - along(0, "end")),
                      1e3 * q * L / E,
                      1e-6);
        const nlohmann::json joint = stages.at(1).at("interfaces").at("joint");
        verdicts.near("normal force [MN]",
                      joint.at("normal force [MN]"),
                      -1e-6 * q,
                      1e-6);
        verdicts.below("opening [mm]", joint.at("largest opening [mm]"), 1e-6);
        const nlohmann::json surface =
          summary.at("interfaces").at("surfaces").at("joint");
        verdicts.below("in the run [mm]",
                       surface.at("largest opening [mm]"),
                       1e-6);
        verdicts.is_true("  nothing to slide",
                         surface.at("smallest sliding safety").is_null());
        const CsvTable history(parameters->output.folder + "/histories.csv");
        double         moved = 0.;
        for (const double z : history.numbers("end displacement z [m]"))
          keep_largest(moved, std::abs(z - along(1, "end")));
        verdicts.below("  end moved by [mm]", 1e3 * moved, 1e-5);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<TiedJoint>
      registered("tied joint", "A joint that is tied once it is grouted.");
  } // namespace
} // namespace Voussoir
