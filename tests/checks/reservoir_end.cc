#include "histories.h"
#include "tank.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    using Complex = std::complex<double>;


    /** Water of depth H before an upright wall, between it and the radiating
     *  end. */
    struct Channel
    {
      double depth, length, frequency, reflection, density, speed;

      /** omega H / c */
      double
      number() const
      {
        return 2. * numbers::PI * frequency * depth / speed;
      }

      /**
       * p(bottom) / rho a H on a floor that moves vertically,
       *   tan(x) / x / (1 + i q tan(x)) , q = (1 - alpha) / (1 + alpha) ,
       * as p = P sin(k (H - z)), -dp/dz = rho a - i omega q p / c at z = 0.
       */
      Complex
      pressure() const
      {
        const double x = number(), q = (1. - reflection) / (1. + reflection);
        return std::tan(x) / x / (1. + Complex(0., 1.) * q * std::tan(x));
      }

      /**
       * Thrust / rho a H^2 on a wall that moves along an infinite channel over
       * a rigid bottom, in modes cos(l z), l H = pi/2, 3 pi/2, ...,
       *   sum of 2 / (l H)^2 / kappa H , kappa^2 = l^2 - (omega/c)^2 ,
       * where waves travel away, kappa = i |kappa|, above the frequency of the
       * mode (Chopra 1967).
       */
      Complex
      thrust() const
      {
        Complex sum = 0.;
        for (unsigned int n = 1; n < 20000; n += 2)
          {
            const double l      = 0.5 * numbers::PI * n;
            const double square = l * l - number() * number();
            sum += 2. / (l * l) /
                   (square > 0. ? Complex(std::sqrt(square)) :
                                  Complex(0., std::sqrt(-square)));
          }
        return sum;
      }
    };


    /** A smooth transition from 0 to 1. */
    double
    ramp(const double x)
    {
      return x >= 1. ?
               1. :
               std::pow(x, 4) * (35. + x * (-84. + x * (70. - 20. * x)));
    }


    /** Complex amplitudes of values at a frequency, in phase with a cosine,
     *  over some whole periods before the end. */
    Complex
    amplitude(const std::vector<double> &times,
              const std::vector<double> &values,
              const double               frequency,
              const unsigned int         periods)
    {
      // by trapezoids, as steps do not divide the period
      const double begin = times.back() - periods / frequency;
      Complex      sum   = 0.;
      const auto   at    = [&](const unsigned int i) {
        return values[i] *
               std::exp(Complex(0., -2. * numbers::PI * frequency * times[i]));
      };
      for (unsigned int i = times.size() - 1; i > 0 && times[i] > begin; --i)
        {
          const double share =
            std::min(1., (times[i] - begin) / (times[i] - times[i - 1]));
          sum += 0.5 * share * (times[i] - times[i - 1]) *
                 ((2. - share) * at(i) + share * at(i - 1));
        }
      return 2. * sum * frequency / static_cast<double>(periods);
    }


    /**
     * The pressure of a floor in vertical motion does not depend on the
     * radiating end, and waves of a wall in horizontal motion leave through
     * this end as in an infinite channel.
     */
    class ReservoirEndMotion : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Settings",
          settings,
          "Depth [m], length [m], frequency [Hz] and reflection "
          "coefficient of the bottom.");
        prm.add_parameter("Direction", direction, "Direction of the motion.");
        prm.add_parameter("Rows", rows, "Rows of cells over the depth.");
        prm.add_parameter("Ramp", duration, "Until the motion is steady [s].");
        prm.add_parameter("Tolerance", tolerance, "Relative.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string &text :
             Utilities::split_string_list(settings, ';'))
          {
            const std::vector<double> setting =
              Utilities::string_to_double(Utilities::split_string_list(text));
            const auto parameters =
              make_case(file.with(entries(setting[0], setting[1], setting[3])));
            const ReservoirParameters &water = parameters->reservoir;
            const Channel              channel{setting[0],
                                  setting[1],
                                  setting[2],
                                  setting[3],
                                  water.density,
                                  water.sound_speed};
            std::ostringstream         name;
            name << channel.depth << " m deep, " << channel.length
                 << " m long, " << channel.frequency << " Hz";
            if (channel.reflection < 1.)
              name << ", bottom " << channel.reflection;
            name << ": ";
            direction == 2 ?
              evaluate_floor(
                channel, *parameters, name.str(), verdicts, communicator) :
              evaluate_wall(
                channel, *parameters, name.str(), verdicts, communicator);
          }
      }

    private:
      std::vector<std::string>
      entries(const double depth, const double length, const double alpha) const
      {
        std::vector<std::string> result;
        const auto set = [&result](const std::string &entry, const auto value) {
          std::ostringstream text;
          text << entry << '=' << value;
          result.push_back(text.str());
        };
        const std::string mesh = "Mesh/gravity section/";
        set(mesh + "Height", depth);
        set(mesh + "Neck elevation", 0.5 * depth);
        set(mesh + "Reservoir level", depth);
        set(mesh + "Reservoir length", length);
        set(mesh + "Rock extent", length);
        set(mesh + "Base width", 2. * depth / rows);
        set(mesh + "Neck width", 2. * depth / rows);
        set(mesh + "Crest width", 2. * depth / rows);
        set(mesh + "Thickness", depth / rows);
        set(mesh + "Cells", "1, 2, " + std::to_string(rows));
        set("Reservoir/Bottom reflection coefficient", alpha);
        return result;
      }

      /** Moves the solid with an acceleration that becomes a cosine of 1 m/s2,
       *  and records one number. */
      Complex
      shake(const Channel                             &channel,
            Tank                                      &tank,
            const std::function<double(const Tank &)> &value) const
      {
        const double        omega = 2. * numbers::PI * channel.frequency;
        std::vector<double> times, values;
        while (tank.time < duration + 4. / channel.frequency)
          {
            const double middle = tank.time + 0.5 * tank.time_step;
            Tensor<1, 3> velocity;
            velocity[direction] =
              ramp(middle / duration) * std::sin(omega * middle) / omega;
            times.push_back(tank.time);
            tank.step(velocity);
            values.push_back(value(tank)); // of the beginning of the step
          }
        return amplitude(times, values, channel.frequency, 4);
      }

      void
      evaluate_floor(const Channel     &channel,
                     Case              &parameters,
                     const std::string &name,
                     Verdicts          &verdicts,
                     const MPI_Comm     communicator) const
      {
        Tank   tank(parameters, communicator);
        double half = 0.;
        for (const auto &x : tank.water_mesh.vertices)
          keep_largest(half, x[0]);
        double        at_foot = 0.; // of the beginning of the next step
        const Complex found   = shake(channel,
                                    tank,
                                    [&](const Tank &now) {
                                      const double value = at_foot;
                                      at_foot =
                                        now.pressure(Point<3>(half, 0., 0.));
                                      return value;
                                    }) /
                              (channel.density * channel.depth);
        verdicts.near(name + "p at the dam's foot / rho a H",
                      std::abs(found),
                      std::abs(channel.pressure()),
                      tolerance);
        verdicts.below("phase [rad]",
                       std::arg(found / channel.pressure()),
                       tolerance);
      }

      void
      evaluate_wall(const Channel     &channel,
                    Case              &parameters,
                    const std::string &name,
                    Verdicts          &verdicts,
                    const MPI_Comm     communicator) const
      {
        Tank          tank(parameters, communicator);
        const double  width = channel.depth / rows;
        const Complex found =
          -shake(channel,
                 tank,
                 [](const Tank &now) { return now.thrust()[1]; }) /
          (channel.density * width * Utilities::fixed_power<2>(channel.depth));
        verdicts.near(name + "thrust / rho a H^2",
                      std::abs(found),
                      std::abs(channel.thrust()),
                      tolerance);
        verdicts.below("phase [rad]",
                       std::arg(found / channel.thrust()),
                       tolerance);
      }

      std::string  settings;
      unsigned int direction = 2, rows = 20;
      double       duration = 10., tolerance = 0.01;
    };


    // Reference: closed form
    const Registry<Check>::Add<ReservoirEndMotion>
      registered("reservoir end", "Motion of floor and wall in closed form.");
  } // namespace
} // namespace Voussoir
