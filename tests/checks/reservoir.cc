#include "histories.h"
#include "tank.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // In these tanks the wall is the plane y = 0 and the water lies at y > 0.
    Tensor<1, 3>
    along_y(const double value)
    {
      return Tensor<1, 3>({0., value, 0.});
    }


    /**
     * A rigid wall in slowly growing acceleration has the pressure of an
     * incompressible reservoir: p(h) = 8/pi^2 rho a H sum_odd sin(n pi h / 2H)
     * / n^2 at depth h.
     */
    class ReservoirPressure : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Ramp", ramp, "Time in which a grows [s].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        Tank       tank(*parameters, communicator);
        double     velocity = 0., half = 0., height = 0., width = 0.;
        for (const auto &x : tank.water_mesh.vertices)
          {
            keep_largest(half, x[0]);
            keep_largest(height, x[2]);
          }
        width = 2. * half;
        while (tank.time < parameters->time.end_time)
          {
            // a grows smoothly to 1 m/s2
            const double a =
              0.5 *
              (1. - std::cos(numbers::PI * std::min(1., tank.time / ramp)));
            velocity += tank.time_step * a;
            tank.step(along_y(velocity));
          }

        const double scale = parameters->reservoir.density * height;
        for (const double depth : {0.25, 0.5, 0.75, 1.})
          {
            double sum = 0.;
            for (unsigned int n = 1; n < 2000; n += 2)
              sum += std::sin(0.5 * n * numbers::PI * depth) / (n * n);
            std::ostringstream name;
            name << "p / rho a H at depth " << depth << " H";
            verdicts.near(
              name.str(),
              tank.pressure(Point<3>(half, 0., (1. - depth) * height)) / scale,
              8. / (numbers::PI * numbers::PI) * sum,
              0.005);
          }
        verdicts.near("thrust / rho a H^2",
                      -tank.thrust()[1] / (scale * height * width),
                      0.5428,
                      0.005);
      }

    private:
      double ramp = 3.;
    };


    /** A tank with rigid walls and a free surface oscillates at c / 4H. */
    class ReservoirResonance : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        Tank       tank(*parameters, communicator);
        Point<3>   corner;
        double     height = 0.;
        for (const auto &x : tank.water_mesh.vertices)
          {
            keep_largest(corner[0], x[0]);
            keep_largest(height, x[2]);
          }
        const double expected =
          parameters->reservoir.sound_speed / (4. * height);
        const double        duration = 1. / expected;
        std::vector<double> times, values;
        while (tank.time < parameters->time.end_time)
          {
            tank.step(
              along_y(pulse(tank.time + 0.5 * tank.time_step, duration)));
            times.push_back(tank.time);
            values.push_back(tank.pressure(corner));
          }
        double found = 0., largest = 0.;
        for (double ratio = 0.9; ratio < 1.1; ratio += 0.0005)
          {
            const double size = std::abs(fourier_sum(
              times, values, ratio * expected, duration, times.back()));
            if (size > largest)
              {
                largest = size;
                found   = ratio * expected;
              }
          }
        verdicts.near("first resonance", found, expected, 0.01, "Hz");
      }
    };


    /**
     * A plane pulse in a channel without free surface: the reflection of the
     * radiating end, and from an absorbing wall.
     */
    class ReservoirReflection : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Duration", duration, "Duration of the pulse [s].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        // at the middle after 1/2, 3/2 and 5/2 passages
        const auto radiating = peaks(file, communicator);
        verdicts.below("reflected by the radiating end",
                       radiating[1] / radiating[0],
                       0.02);
        for (const double alpha : {0.75, 0.3})
          {
            std::ostringstream coefficient, name;
            coefficient << "Reservoir/Bottom reflection coefficient=" << alpha;
            const auto closed = peaks(file.with({"Reservoir/Radiating end=",
                                                 "Reservoir/Dam=",
                                                 coefficient.str()}),
                                      communicator);
            verdicts.near("reflected by a closed end",
                          closed[1] / closed[0],
                          1.,
                          0.02);
            verdicts.near("reflected by the absorbing wall",
                          closed[2] / closed[1],
                          alpha,
                          0.02);
          }
      }

    private:
      std::array<double, 3>
      peaks(const ParameterFile &file, const MPI_Comm communicator) const
      {
        const auto parameters = make_case(file);
        Tank       tank(*parameters, communicator);
        Point<3>   middle;
        for (const auto &x : tank.water_mesh.vertices)
          {
            keep_largest(middle[0], x[0]);
            keep_largest(middle[1], 0.5 * x[1]);
          }
        const double passage =
          2. * middle[1] / parameters->reservoir.sound_speed;
        std::array<double, 3> result{};
        while (tank.time < 3. * passage)
          {
            tank.step(
              along_y(pulse(tank.time + 0.5 * tank.time_step, duration)));
            double &peak =
              result[std::min(2, static_cast<int>(tank.time / passage))];
            keep_largest(peak, std::abs(tank.pressure(middle)));
          }
        return result;
      }

      double duration = 0.1;
    };


    /** Without losses the discrete energy of the water is constant, and
     *  otherwise it is the work less the losses. */
    class ReservoirEnergy : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const double duration = 0.1;
        {
          const auto parameters =
            make_case(file.with({"Reservoir/Radiating end=",
                                 "Reservoir/Bottom reflection coefficient=1"}));
          Tank   tank(*parameters, communicator);
          double least = 1e300, most = 0.;
          while (tank.time < parameters->time.end_time)
            {
              tank.step(along_y(pulse(tank.time, duration)));
              if (tank.time > duration + tank.time_step)
                {
                  const double energy = tank.water.stored_energy();
                  keep_smallest(least, energy);
                  keep_largest(most, energy);
                }
            }
          verdicts.above("closed tank: energy [kJ]", 1e-3 * most, 0.1);
          verdicts.below("closed tank: relative change of the energy",
                         (most - least) / most,
                         1e-10);
        }

        const auto parameters = make_case(file);
        Tank       tank(*parameters, communicator);
        double     most = 0., worst = 0., lost = 0.;
        while (tank.time < parameters->time.end_time)
          {
            tank.step(along_y(pulse(tank.time, duration)),
                      along_y(-0.5 * pulse(tank.time, 2. * duration)));
            const WaterMotion  &water = tank.water;
            std::vector<double> sums{water.loss,
                                     water.work_on_solid,
                                     water.work_on_base};
            Utilities::MPI::sum(sums, communicator, sums);
            lost                = sums[0];
            const double stored = water.stored_energy();
            keep_largest(most, stored);
            keep_largest(worst, std::abs(stored + sums[0] + sums[1] + sums[2]));
          }
        verdicts.above("open tank: lost over largest stored energy",
                       lost / most,
                       0.5);
        verdicts.below("open tank: error of the balance over stored energy",
                       worst / most,
                       1e-10);
      }
    };


    /** Any number of ranks computes the same. */
    class ReservoirRanks : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto alone = history(file, "p4est", MPI_COMM_SELF);
        for (const std::string partition : {"p4est", "METIS"})
          {
            const auto together = history(file, partition, communicator);
            for (unsigned int kind = 0; kind < alone.size(); ++kind)
              {
                double difference = 0., size = 0.;
                for (unsigned int i = 0; i < alone[kind].size(); ++i)
                  {
                    keep_largest(size, std::abs(alone[kind][i]));
                    keep_largest(difference,
                                 std::abs(alone[kind][i] - together[kind][i]));
                  }
                const std::string name =
                  std::vector<std::string>{"thrust [MN]",
                                           "energy and loss [MJ]"}[kind];
                verdicts.above(name + ", by " + partition, 1e-6 * size, 0.1);
                verdicts.below("difference to one rank",
                               difference / size,
                               1e-10);
              }
          }
      }

    private:
      static std::array<std::vector<double>, 2>
      history(const ParameterFile &file,
              const std::string   &partition,
              const MPI_Comm       communicator)
      {
        const auto parameters =
          make_case(file.with({"Mesh/Partition=" + partition}));
        Tank                               tank(*parameters, communicator);
        std::array<std::vector<double>, 2> result;
        while (tank.time < parameters->time.end_time)
          {
            tank.step(along_y(pulse(tank.time, 0.1)));
            const Tensor<1, 3> thrust = tank.thrust();
            for (unsigned int d = 0; d < 3; ++d)
              result[0].push_back(thrust[d]);
            result[1].push_back(tank.water.stored_energy());
            result[1].push_back(
              Utilities::MPI::sum(tank.water.loss, communicator));
          }
        return result;
      }
    };


    // Reference: closed form
    const Registry<Check>::Add<ReservoirPressure>
      pressure("reservoir pressure", "Slow motion of a rigid wall.");
    // Reference: closed form
    const Registry<Check>::Add<ReservoirResonance>
      resonance("reservoir resonance", "The lowest frequency of a tank.");
    // Reference: closed form
    const Registry<Check>::Add<ReservoirReflection>
      reflection("reservoir reflection", "At the end and at the bottom.");
    // Reference: closed form
    const Registry<Check>::Add<ReservoirEnergy>
      energy("reservoir energy", "Energy of the water by itself.");
    // Reference: Voussoir
    const Registry<Check>::Add<ReservoirRanks>
      ranks("reservoir ranks", "Any number of ranks computes the same.");
  } // namespace
} // namespace Voussoir
