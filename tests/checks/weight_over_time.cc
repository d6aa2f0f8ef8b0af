#include "check.h"
#include "histories.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A rod that stands on its end gets its weight at once: its top falls
     * freely, g t^2/2, until the wave from the base arrives at L/c, and reaches
     * g L^2/c^2 at 2 L/c, twice the static displacement. And weight over time
     * is inertia on a base that moves the other way.
     */
    class WeightOverTime : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tolerance",
                          tolerance,
                          "Tolerance of the closed form.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const std::vector<NamedPoint> top{{"top", Point<3>(1., 1., 30.)}};
        const auto                    parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const double c          = simulation->model.solid.materials[0]
                           ->elastic_constants()
                           .p_wave_speed();
        const double L       = 30.;
        const auto   history = run_and_record(*simulation, top);
        const auto   u       = [&](const double t) {
          std::size_t i = 1;
          while (history.times.at(i) < t)
            ++i;
          const double share = (t - history.times[i - 1]) /
                               (history.times[i] - history.times[i - 1]);
          return (1. - share) * history.displacement[0][i - 1][2] +
                 share * history.displacement[0][i][2];
        };
        // a sudden load acts from half a step before
        const auto fallen = [&](const double t) {
          return t * (t + simulation->run.time_step.length);
        };
        for (const double share : {0.5, 0.9})
          {
            std::ostringstream name;
            name << "free fall of the top at " << share << " L/c";
            verdicts.near(name.str(),
                          1e3 * u(share * L / c),
                          -1e3 * 0.5 * 9.81 * fallen(share * L / c),
                          tolerance,
                          "mm");
          }
        verdicts.near("lowest place of the top, at 2 L/c",
                      1e3 * u(2. * L / c),
                      -1e3 * 9.81 * std::pow(L / c, 2),
                      tolerance,
                      "mm");

        // slowly, as in a static stage
        const auto slow =
          make_case(file.with({"Loads/weight/Time function="
                               "if(t < 1, sin(pi*t/2)^2, 1)",
                               "Damping/Model=mass proportional",
                               "Damping/Ratio=0.3",
                               "Damping/Lowest frequency=19",
                               "Time/End time=1.6"}));
        const auto slow_run = make_simulation(*slow, communicator);
        verdicts.near(
          "slowly",
          1e3 * run_and_record(*slow_run, top).displacement[0].back()[2],
          -1e3 * 0.5 * 9.81 * std::pow(L / c, 2),
          1e-4,
          "mm");

        // inclined, against a base that moves to the right and up
        const std::vector<std::string> damped{
          "Damping/Model=Maxwell", "Boundaries/Roller=", "Time/End time=0.5"};
        auto weighing = damped, moved = damped;
        weighing.push_back("Loads/weight/Acceleration=-1.962,0,-3.924");
        weighing.push_back("Loads/weight/Time function=sin(2*pi*4*t)");
        for (const std::string change :
             {"Loads/weight/Active=false",
              "Ground motion/Type=sine",
              "Ground motion/Peak acceleration x=0.2",
              "Ground motion/Peak acceleration z=0.4",
              "Ground motion/Sine/Frequency=4",
              "Ground motion/Sine/Cycles=0",
              "Ground motion/Sine/Ramp cycles=0",
              "Wave field/Enters through=rigid base"})
          moved.push_back(change);
        const auto first      = make_case(file.with(weighing)),
                   second     = make_case(file.with(moved));
        const auto first_run  = make_simulation(*first, communicator),
                   second_run = make_simulation(*second, communicator);
        const auto a          = run_and_record(*first_run, top),
                   b          = run_and_record(*second_run, top);
        double difference = 0., size = 0.;
        for (std::size_t i = 0; i < a.times.size(); ++i)
          {
            const Tensor<1, 3> v = a.displacement[0][i],
                               w = b.displacement[0].at(i);
            keep_largest(size, w.norm());
            keep_largest(difference, (v - w).norm());
          }
        verdicts.above("motion on a base that moves [mm]", 1e3 * size, 0.5);
        verdicts.below(
          "weight over time against a base: difference over motion",
          difference / size,
          1e-9);
      }

    private:
      double tolerance = 0.01;
    };

    // Reference: closed form
    const Registry<Check>::Add<WeightOverTime>
      registered("weight over time", "Sudden, slow, and as inertia.");
  } // namespace
} // namespace Voussoir
