#include <voussoir/base/gravity.h>

#include "contact_sums.h"

namespace Voussoir
{
  namespace
  {
    /**
     * A lift joint of a dam beside cells of water carries the weight above it,
     * and opens along the wetted edge, too: a pull at the crest whose moment
     * passes that of the weight overturns the dam.
     */
    class LiftBesideWater : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const std::string section = "Mesh/gravity section/";
        const double      width   = number_in(file, section + "Base width"),
                     thickness    = number_in(file, section + "Thickness"),
                     height       = number_in(file, section + "Height"),
                     lift         = number_in(file, section + "Lift height");
        const double weight       = number_in(file, "Materials/dam/Density") *
                              standard_gravity * width * thickness *
                              (height - lift);

        const auto parameters =
          make_case(file.with({"Static state/Stages=weight"}));
        const auto simulation = make_simulation(*parameters, communicator);
        verdicts.near("normal force on the lift joint [MN]",
                      1e-6 * contact_sums(*simulation, 0).pressure,
                      1e-6 * weight,
                      1e-4);
        const double overturning = 0.5 * weight / ((height - lift) * thickness);
        for (const auto &[share, expected] :
             {std::pair(0.5, true), std::pair(1.1, false)})
          verdicts.is_true(
            "stands at " + std::to_string(share).substr(0, 3) +
              " of the pull that overturns it: " + (expected ? "yes" : "no"),
            stands(file.with({"Static state/Stages=weight; pull",
                              "Loads/pull/Traction=0, " +
                                std::to_string(-share * overturning) + ", 0"}),
                   communicator) == expected);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<LiftBesideWater>
      registered("lift beside water",
                 "A lift joint that ends at cells of water.");
  } // namespace
} // namespace Voussoir
