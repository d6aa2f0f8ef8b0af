#include "contact_sums.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A wedge in the bank of an arch dam, which is so soft that it does not
     * support the wedge, in the static state under its own weight. The base
     * plane dips towards the river, away from lateral and rear release planes,
     * so that it alone carries the wedge as a block on an inclined plane: the
     * safety is friction over the tangent of the dip.
     */
    class AbutmentWedgeSafety : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const double dip = std::stod(
                       file.given("Mesh/arch dam/Left wedge/Dip", "0")),
                     friction = std::stod(
                       file.given("Interfaces/planes/Friction coefficient",
                                  "0"));
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        verdicts.near("static safety factor of the wedge",
                      block_safety(*simulation,
                                   "left wedge: left wedge base, left wedge "
                                   "lateral plane, left wedge rear plane"),
                      friction / std::tan(dip * numbers::PI / 180.),
                      0.01);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<AbutmentWedgeSafety>
      registered("abutment wedge safety", "A wedge on a plane that dips.");
  } // namespace
} // namespace Voussoir
