#include <voussoir/base/mpi.h>
#include <voussoir/base/text.h>

#include "contact_sums.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A bar of length L and section b h that friction resists by q = (f p + c)
     * b per length: pulled at its end by F, let go and pushed back by F,
     * quasi-statically. A first change of the force by dF slides the bar over
     * dF / q from its end; a reversal slides half that length, against twice
     * the friction; with d = 1 or 2 the end moves by
     *   dF^2 / (2 d E b h q) ,
     * and the integral of the slip grows by dF^3 / (6 d^2 E b h q^2).
     */
    class DraggedBar : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Section", section, "Width, height [m].");
        prm.declare_entry("Pressure", "1e6", Patterns::Double(), "[Pa].");
        prm.add_parameter("Traction", traction, "At its end [Pa].");
        prm.add_parameter(
          "Duration",
          duration,
          "Duration of each of the three ways of the load [s]; 0 for "
          "static stages.");
        prm.declare_entry("Stages",
                          "",
                          Patterns::Anything(),
                          "The static stages of the three ways, separated by "
                          "\">\".");
        prm.add_parameter(
          "Settings",
          settings,
          "Entries that are changed, each time after a name, as "
          "in \"name: entry = value & entry = value | ...\".");
        prm.add_parameter("Tolerance", tolerance, "Tolerance of the slip.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string &setting : split_list(settings, '|'))
          {
            const auto                     colon = setting.find(':');
            const std::vector<std::string> changes =
              split_list(setting.substr(colon + 1), '&');
            compare(setting.substr(0, colon) + ": ",
                    file.with(changes),
                    verdicts,
                    communicator);
          }
      }

    private:
      struct Slip
      {
        double end = 0., integral = 0.; // [m], [m2]
      };

      void
      compare(const std::string   &name,
              const ParameterFile &file,
              Verdicts            &verdicts,
              const MPI_Comm       communicator) const
      {
        const std::string place = "Interfaces/plane/";
        const auto        entry = [&](const std::string &which) {
          const std::string given = file.given(place + which);
          return given.empty() ? 0. : std::stod(given);
        };
        const double pressure = std::stod(file.given("Check/Pressure")),
                     resistance =
                       section[0] * (entry("Friction coefficient") * pressure +
                                     entry("Cohesion")),
                     stiffness =
                       section[0] * section[1] *
                       std::stod(file.given("Materials/stone/Young's modulus")),
                     force = traction * section[0] * section[1];
        // increment due to a change of the force
        const auto change = [&](const double by, const double d) {
          const double size = std::abs(by);
          return Slip{by * size / (2. * d * stiffness * resistance),
                      by * size * size /
                        (6. * d * d * stiffness * resistance * resistance)};
        };
        const Slip pulled = change(force, 1.), back = change(-force, 2.),
                   pushed = change(-2. * force, 2.);
        const std::array<Slip, 3> reference{
          {pulled,
           {pulled.end + back.end, pulled.integral + back.integral},
           {pulled.end + pushed.end, pulled.integral + pushed.integral}}};

        const std::array<Slip, 3>         found = duration > 0. ?
                                                    over_time(file, communicator) :
                                                    in_stages(file, communicator);
        const std::array<const char *, 3> when{{"pulled", "let go", "pushed"}};
        for (unsigned int i = 0; i < 3; ++i)
          {
            verdicts.near(name + when[i] + ", slip of its end [mm]",
                          1e3 * found[i].end,
                          1e3 * reference[i].end,
                          tolerance);
            verdicts.near(name + when[i] + ", integral of the slip [mm m]",
                          1e3 * found[i].integral,
                          1e3 * reference[i].integral,
                          tolerance);
          }
      }

      /** Slip along x; the end is at the largest x. */
      static Slip
      slip(const Simulation &simulation)
      {
        const Contact &contact      = *simulation.run.contact;
        const MPI_Comm communicator = simulation.model.grid.communicator();
        double         length       = 0.;
        for (const Point<3> &x : contact.positions())
          length = std::max(length, x[0]);
        length = Utilities::MPI::max(length, communicator);
        std::vector<double> sums(4);
        for (unsigned int k = 0; k < contact.points().size(); ++k)
          {
            const ContactPoint &point = contact.points()[k];
            const double        along = (point.gap * point.frame)[0];
            sums[0] += point.area * along;
            sums[1] += point.area;
            if (contact.positions()[k][0] > length - 1e-6)
              {
                sums[2] += point.area * along;
                sums[3] += point.area;
              }
          }
        sums = sum_over_ranks(sums, communicator);
        return {sums[2] / sums[3], length * sums[0] / sums[1]};
      }

      std::array<Slip, 3>
      over_time(const ParameterFile &file, const MPI_Comm communicator) const
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        std::array<Slip, 3> found;
        for (unsigned int i = 0; i < 3; ++i)
          {
            while (simulation->run.state.time < (i + 1) * duration)
              simulation->run.scheme.step(simulation->run.state);
            found[i] = slip(*simulation);
          }
        return found;
      }

      /** Each movement with all before it. */
      std::array<Slip, 3>
      in_stages(const ParameterFile &file, const MPI_Comm communicator) const
      {
        std::array<Slip, 3> found;
        std::string         so_far = "weight";
        const auto          ways = split_list(file.given("Check/Stages"), '>');
        for (unsigned int i = 0; i < 3; ++i)
          {
            so_far += "; " + ways.at(i);
            const auto parameters =
              make_case(file.with({"Static state/Stages=" + so_far}));
            found[i] = slip(*make_simulation(*parameters, communicator));
          }
        return found;
      }

      Tensor<1, 2> section{{1., 1.}};
      double pressure = 1e6, traction = 1e6, duration = 0., tolerance = 0.02;
      std::string settings, stages;
    };

    // Reference: closed form
    const Registry<Check>::Add<DraggedBar>
      registered("contact dragged bar",
                 "A bar that is dragged over friction and let go.");
  } // namespace
} // namespace Voussoir
