#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A block on a level plane with the weight w, pushed by p, both per area
     * and applied smoothly during T. Afterwards its slip is a (T^2/4 - T^2/pi^2
     * + T (t - T)/2 + (t - T)^2/2) , a = (p - f w) g/w . From a slip of half a
     * cell on the run warns; with more friction the block does not slide.
     */
    class WideSlip : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        verdicts.is_true("friction 0.9: no warning",
                         warning_of(file, 0.9, communicator).empty());
        const std::string text = warning_of(file, 0.6, communicator);
        verdicts.is_true("friction 0.6: a warning", !text.empty());
        if (text.empty())
          return;

        constexpr double T = 0.08, half_cell = 0.25,
                         a = (0.8 - 0.6) * 9.81; // [s], [m], [m/s2]
        const double slip_of_T =
          a * T * T * (0.25 - 1. / (numbers::PI * numbers::PI));
        const double v = 0.5 * a * T;
        const double t =
          T + (std::sqrt(v * v + 2. * a * (half_cell - slip_of_T)) - v) / a;
        // checked every tenth of a second
        verdicts.near("  at the time [s]",
                      time_in(text),
                      std::ceil(10. * t) / 10.,
                      1e-3);
      }

    private:
      /** The warning of the slip of the plane, if any. */
      static std::string
      warning_of(const ParameterFile &file,
                 const double         friction,
                 const MPI_Comm       communicator)
      {
        const nlohmann::json warnings =
          warnings_of(file,
                      "Interfaces/plane/Friction coefficient=" +
                        std::to_string(friction),
                      "wide_slip",
                      communicator);
        for (const std::string text : warnings)
          if (text.find("\"plane\" has slipped") != std::string::npos)
            return text;
        return {};
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<WideSlip>
      registered("wide slip", "The warning of a slip beyond half a cell.");
  } // namespace
} // namespace Voussoir
