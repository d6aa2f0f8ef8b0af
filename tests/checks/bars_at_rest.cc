#include "contact_sums.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A rod between fixed ends with bars across a joint, that cools: with the
     * opening w, the stress of the rod s and its static modulus a E,
     *   w + L (alpha T + s / (a E)) = 0 , s = r min(f_y, E_s w / l) ,
     * and r, f_y, E_s, l of the bars; and a part that the bars alone hold.
     */
    class BarsAtRest : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const double modulus =
                       number_in(file, "Materials/stone/Young's modulus") *
                       number_in(file, "Materials/stone/Static factor"),
                     strain =
                       -number_in(file, "Materials/stone/Thermal expansion") *
                       number_in(file, "Loads/cold/Uniform change"),
                     ratio = number_in(file, "Interfaces/joint/Steel ratio"),
                     stiffness =
                       ratio *
                       number_in(file, "Interfaces/joint/Steel modulus") /
                       number_in(file, "Interfaces/joint/Free length");
        for (const double yield : {10e6, 30e6, 40e6, 1000e6})
          {
            const double opening =
              std::max(strain * length / (1. + stiffness * length / modulus),
                       length * (strain - ratio * yield / modulus));
            const double force =
              area * std::min(stiffness * opening, ratio * yield);
            const auto parameters  = make_case(file.with(
              {"Interfaces/joint/Yield stress=" + std::to_string(yield)}));
            const auto simulation  = make_simulation(*parameters, communicator);
            const ContactSums sums = contact_sums(*simulation, 0);
            verdicts.near("yield stress " + std::to_string(int(yield / 1e6)) +
                            " MPa: force of the bars [MN]",
                          -1e-6 * sums.given,
                          1e-6 * force,
                          1e-3);
            verdicts.near("  opening [mm]",
                          1e3 * sums.opening,
                          1e3 * opening,
                          1e-3);
          }

        const double pull =
          0.8 * ratio * number_in(file, "Interfaces/joint/Yield stress");
        const auto held = make_case(
          file.with({"Loads/Names=pull",
                     "Loads/pull/Class=surface load",
                     "Loads/pull/Face sets=top",
                     "Loads/pull/Traction=0, 0, " + std::to_string(pull),
                     "Static state/Stages=pull",
                     "Boundaries/Roller=bottom, left, front"}));
        const auto        simulation = make_simulation(*held, communicator);
        const ContactSums sums       = contact_sums(*simulation, 0);
        verdicts.above("pulled: steps of dynamic relaxation",
                       simulation->static_state.summary.at("stages")
                         .at(0)
                         .at("steps of dynamic relaxation")
                         .get<double>(),
                       1.);
        verdicts.near("  opening [mm]",
                      1e3 * sums.opening,
                      1e3 * pull / stiffness,
                      1e-3);
        verdicts.near("  force of the bars [MN]",
                      -1e-6 * sums.given,
                      1e-6 * area * pull,
                      1e-3);
      }

      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Length", length, "Of the rod [m].");
        prm.add_parameter("Area", area, "Of its section [m2].");
      }

    private:
      double length = 4., area = 4.;
    };

    // Reference: closed form
    const Registry<Check>::Add<BarsAtRest>
      registered("bars at rest",
                 "Bars across a joint yield in a static stage.");
  } // namespace
} // namespace Voussoir
