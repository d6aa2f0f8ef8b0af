#include "check.h"
#include "histories.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Motion relative to a rigid base under inertial forces, plus the motion of
     * the base, is the motion of the same body on a base that is moved.
     */
    class RigidBase : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        // a = A sin(w t) from rest: u = A/w^2 (w t - sin w t); 0.1 g, 2 Hz
        const double omega = 4. * numbers::PI, amplitude = 0.1 * 9.81;
        const auto   ground = [&](const double t) {
          return amplitude / (omega * omega) *
                 (omega * t - std::sin(omega * t));
        };
        const std::vector<NamedPoint> points{{"top", Point<3>(5., 5., 30.)}};
        const auto relative = history(file, points, communicator);
        const auto moved =
          history(file.with(
                    {"Ground motion/Type=none",
                     "Boundaries/Fixed=",
                     "Constraints/Names=base",
                     "Constraints/base/Face sets=bottom",
                     "Constraints/base/Displacement=" +
                       std::to_string(amplitude) + ",0,0",
                     "Constraints/base/Time function=(4*pi*t-sin(4*pi*t))"
                     "/(4*pi)^2"}),
                  points,
                  communicator);

        double difference = 0., size = 0.;
        for (unsigned int i = 0; i < relative.times.size(); ++i)
          {
            const double u = relative.displacement[0][i][0];
            keep_largest(size, std::abs(u));
            keep_largest(difference,
                         std::abs(u + ground(relative.times[i]) -
                                  moved.displacement[0][i][0]));
          }
        verdicts.above("largest relative displacement [mm]", 1e3 * size, 1.);
        verdicts.below("absolute motion: difference over relative motion",
                       difference / size,
                       0.01);
      }

    private:
      static Histories
      history(const ParameterFile           &file,
              const std::vector<NamedPoint> &points,
              const MPI_Comm                 communicator)
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        return run_and_record(*simulation, points);
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<RigidBase>
      registered("rigid base", "Inertial input against a moving base.");
  } // namespace
} // namespace Voussoir
