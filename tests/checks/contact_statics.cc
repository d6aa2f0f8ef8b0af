#include "contact_sums.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A cube on a frictional base: in the static state the contact
     * carries its weight; on an incline, the plane of which is level and the
     * weight tilted, it stays up to tan(theta) = f and then slides with g (sin
     * - f cos).
     */
    class Incline : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto weight = [](const double along, const double normal) {
          return vector_entry("Loads/weight/Acceleration",
                              Tensor<1, 3>({along, 0., -normal}));
        };
        const std::string no_push = "Loads/push/Traction=0, 0, 0";
        const auto        tilted  = [&](const double slope) {
          const double angle = std::atan(slope);
          return file.with(
            {weight(gravity * std::sin(angle), gravity * std::cos(angle)),
             no_push});
        };

        // a stone of 1 m3
        const double mass = density;
        {
          const auto parameters =
            make_case(file.with({weight(0., gravity), no_push}));
          const auto   simulation = make_simulation(*parameters, communicator);
          Tensor<1, 3> rest       = contact_sums(*simulation, 0).force;
          rest[2] -= mass * gravity;
          verdicts.below("level: contact force minus weight, over weight",
                         rest.norm() / (mass * gravity),
                         1e-10);
        }
        {
          const auto   parameters = make_case(tilted(0.99 * friction));
          const auto   simulation = make_simulation(*parameters, communicator);
          const double angle      = std::atan(0.99 * friction);
          Tensor<1, 3> rest       = contact_sums(*simulation, 0).force;
          rest[0] += mass * gravity * std::sin(angle);
          rest[2] -= mass * gravity * std::cos(angle);
          verdicts.below("tan(theta) = 0.99 f sticks: force over weight",
                         rest.norm() / (mass * gravity),
                         1e-10);
        }
        verdicts.is_true("tan(theta) = 1.01 f slides",
                         !stands(tilted(1.01 * friction), communicator));

        // first the normal part of the weight acts, then the part along the
        // plane as a traction on the back of the block
        const double angle      = std::atan(2. * friction);
        const double push       = density * gravity * std::sin(angle);
        const auto   parameters = make_case(file.with(
          {weight(0., gravity * std::cos(angle)),
             vector_entry("Loads/push/Traction", Tensor<1, 3>({push, 0., 0.}))}));
        const auto   simulation = make_simulation(*parameters, communicator);
        while (simulation->run.state.time < parameters->time.end_time)
          {
            simulation->run.scheme.step(simulation->run.state);
            simulation->run.energy.evaluate(simulation->run.state);
          }
        const double time = simulation->run.state.time;
        const double acceleration =
          gravity * (std::sin(angle) - friction * std::cos(angle));
        verdicts.near("tan(theta) = 2 f: acceleration [m/s2]",
                      2. * mean_motion(*simulation)[0] / (time * time),
                      acceleration,
                      0.005);
        verdicts.near("lost in friction [kJ]",
                      1e-3 * contact_sums(*simulation, 0).friction_work,
                      0.5e-3 * friction * mass * gravity * std::cos(angle) *
                        acceleration * time * time,
                      0.005);
        verdicts.below("energy-balance error over input [%]",
                       100. * simulation->run.energy.relative_error(),
                       0.5);
        verdicts.below("penetration over cell size",
                       simulation->run.contact->effort().penetration /
                         simulation->run.contact->cell_size(),
                       1e-10);
      }

    private:
      static constexpr double gravity = 9.81, density = 2000., friction = 0.5;
    };

    // Reference: closed form
    const Registry<Check>::Add<Incline>
      registered("contact incline", "A cube on a level and inclined base.");
  } // namespace
} // namespace Voussoir
