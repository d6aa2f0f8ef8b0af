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
        verdicts.is_true("60 mm: no warning",
                         warnings_at(file, 0.06, communicator).empty());
        const nlohmann::json warnings = warnings_at(file, 0.14, communicator);
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
                           "wide_crack",
                           communicator);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<WideCrack>
      registered("wide crack", "The warning of a detached block.");
  } // namespace
} // namespace Voussoir
