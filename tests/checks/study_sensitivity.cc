#include "check.h"
#include "folders.h"
#include "study_results.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The settlement rho g H^2 / 2 E of a column, with each number of its file
     * moved by a hundredth: proportional to the density, to the square of the
     * height, inverse to the stiffness, and not changed by the width.
     */
    class SensitivityOfColumn : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders({"sensitivity"}, communicator);
        const ParameterFile column =
          study_file(file, "study_columns", "sensitivity")
            .with({"Study/Vary=",
                   "Study/Sensitivity/Change=0.01",
                   "Materials/stone/Density=2000",
                   "Materials/stone/Young's modulus=1e9",
                   "Time/Safety factor=1"});
        const auto found = results_of(column, communicator);
        // with the safety factor lowered, which cannot be raised
        verdicts.is_true("runs of six numbers, and one as given",
                         found.at("runs").size() == 12);
        verdicts.is_true("one move is refused",
                         found.at("sensitivity").at("refused").size() == 1);
        const auto lines = found.at("sensitivity").at("numbers");
        verdicts.is_true("six numbers, the height first",
                         lines.size() == 6 &&
                           lines.at(0).at("number") ==
                             "Mesh/box/Upper corner, number 3");
        // (1.01^n - 0.99^n) / 0.02
        const std::map<std::string, double> expected{
          {"Mesh/box/Upper corner, number 3", 2.},
          {"Materials/stone/Young's modulus", -1.00010001},
          {"Materials/stone/Density", 1.},
          {"Mesh/box/Upper corner, number 1", 0.},
          {"Mesh/box/Upper corner, number 2", 0.},
          {"Time/Safety factor", 0.}};
        for (const auto &[name, power] : expected)
          for (const nlohmann::json &line : lines)
            if (line.at("number") == name)
              {
                const double change = line.at("change over that of the number");
                if (power == 0.)
                  verdicts.below(name, change, 1e-4);
                else
                  verdicts.near(name, change, power, 1e-4);
              }
        verdicts.near("largest change [%]",
                      lines.at(0).at("largest change [%]"),
                      2.01,
                      1e-4);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<SensitivityOfColumn>
      column("sensitivity of a column", "Each number moved by a little.");
  } // namespace
} // namespace Voussoir
