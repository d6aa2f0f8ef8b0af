#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A bar with one weak cell of 3.25 m, pulled by A sin(0.05 pi t)^2: once it
     * has cracked all of this displacement is the opening of the crack. At a
     * fiftieth of the cell, 65 mm, the run warns.
     */
    class WideCrack : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        verdicts.is_true("1 mm: no crack, no warning",
                         warnings_at(file, 1e-3, communicator).empty());
        const char *share = "crack over its cell";
        verdicts.near("  crack over its cell",
                      read_summary(folder).at("detachment").at(share),
                      0.,
                      0.);
        verdicts.is_true("60 mm: no warning",
                         warnings_at(file, 0.06, communicator).empty());
        verdicts.near("  crack over its cell",
                      read_summary(folder).at("detachment").at(share),
                      0.06 / 3.25 * std::pow(std::sin(0.3 * numbers::PI), 2),
                      0.05);
        const nlohmann::json warnings = warnings_at(file, 0.14, communicator);
        verdicts.same_text("140 mm: verdict",
                           read_summary(folder).at("verdict"),
                           "not met: detached: crack over its cell");
        verdicts.is_true("140 mm: one warning, of cracks",
                         warnings.size() == 1 &&
                           warnings.at(0).get<std::string>().find("a crack is "
                                                                  "open") !=
                             std::string::npos);
        const std::string text = warnings.at(0);
        // checked every tenth of a second
        verdicts.near("  at the time [s]",
                      time_in(text),
                      std::asin(std::sqrt(65. / 140.)) / (0.05 * numbers::PI) +
                        0.05,
                      0.03);
        verdicts.is_true("  its detachment is a reliable result",
                         text.find("its detachment is a reliable result") !=
                           std::string::npos);

        const nlohmann::json brittle =
          warnings_at(file.with({"Materials/weak/Fracture energy=120"}),
                      0.14,
                      communicator);
        verdicts.is_true(
          "where its cell lowers the strength it is not",
          brittle.size() == 1 &&
            brittle.at(0).get<std::string>().find(
              "neither its detachment nor its motion afterwards is a reliable "
              "result, as long cells lower the strength") != std::string::npos);
      }

    private:
      static nlohmann::json
      warnings_at(const ParameterFile &file,
                  const double         amplitude,
                  const MPI_Comm       communicator)
      {
        return warnings_of(file,
                           "Constraints/pull/Displacement=0, 0, " +
                             std::to_string(amplitude),
                           folder,
                           communicator);
      }

      static constexpr const char *folder = "wide_crack";
    };

    // Reference: closed form
    const Registry<Check>::Add<WideCrack>
      registered("wide crack", "The warning of a detached block.");
  } // namespace
} // namespace Voussoir
