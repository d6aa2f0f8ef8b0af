#include <voussoir/output/sliding_block.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A block in the corner of a floor (up z), a side wall (at its lower x) and
     * a back wall (at its lower y), pressed and driven in all modes of sliding.
     */
    class SlidingBlockModes : public Check
    {
    public:
      void
      run(const ParameterFile &, Verdicts &verdicts, const MPI_Comm) override
      {
        // with the force that loads the block
        verdicts.near("away from both walls, on the floor",
                      safety(0.3, 0.4, -1.),
                      floor_friction * 1. / 0.5,
                      1e-12);
        verdicts.near("along the side wall",
                      safety(-0.3, 0.4, -1.),
                      (floor_friction * 1. + side_friction * 0.3 + cohesion) /
                        0.4,
                      1e-12);
        verdicts.near("along the back wall",
                      safety(0.3, -0.4, -1.),
                      (floor_friction * 1. + back_friction * 0.4) / 0.3,
                      1e-12);
        verdicts.near("up the edge of the walls",
                      safety(-0.3, -0.4, 1.),
                      (side_friction * 0.3 + cohesion + back_friction * 0.4) /
                        1.,
                      1e-12);
        verdicts.near("up the side wall, away from the back one",
                      safety(-0.5, 0.3, 0.4),
                      (side_friction * 0.5 + cohesion) / 0.5,
                      1e-12);
        verdicts.is_true("into both walls: it is blocked",
                         std::isinf(safety(-0.3, -0.4, -1.)));
        verdicts.is_true("away from all: it lifts off",
                         safety(0.3, 0.4, 1.) == 0.);
        verdicts.is_true("without a driving force: infinite",
                         std::isinf(safety(0., 0., -1.)));
      }

    private:
      static double
      safety(const double x, const double y, const double z)
      {
        return sliding_safety(
          {{Tensor<1, 3>({0., 0., 1.}), floor_friction, 0.},
           {Tensor<1, 3>({1., 0., 0.}), side_friction, cohesion},
           {Tensor<1, 3>({0., 1., 0.}), back_friction, 0.}},
          Tensor<1, 3>({-x, -y, -z}));
      }

      static constexpr double floor_friction = 0.5, side_friction = 0.25,
                              back_friction = 0.4, cohesion = 0.1;
    };

    // Reference: closed form
    const Registry<Check>::Add<SlidingBlockModes>
      registered("sliding block", "Ways in which a block can slide.");
  } // namespace
} // namespace Voussoir
