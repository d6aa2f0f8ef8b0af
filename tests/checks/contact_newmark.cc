#include <voussoir/base/mpi.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Newmark's block: a stiff block under its weight on a base that moves with
     * A sin(wt), optionally pushed by a steady force along it or shaken up and
     * down at the same time, against the motion of a point mass with dry
     * friction f m (g + a_v), and with cohesion that breaks.
     */
    class Newmark : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Push", push, "Steady acceleration [m/s2].");
        prm.add_parameter("Friction", friction, "Coefficient.");
        prm.add_parameter("Vertical",
                          vertical,
                          "Acceleration of the base upwards over that along "
                          "it.");
        prm.add_parameter("Cohesion", cohesion, "Over mass per area [m/s2].");
        prm.add_parameter("Direction", direction, "Of the slip.");
        prm.add_parameter("Cycles", cycles, "To compare.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        if (cohesion > 0.)
          {
            // first slip at f g + c A / m
            const double holds =
              (1.01 * amplitude - friction * gravity) / cohesion;
            const std::string entry = "Interfaces/plane/Cohesion";
            verdicts.below(
              "slip where the strength is 1.01 of the shaking [mm]",
              1e3 * largest_slip(file.with(
                                   {entry + '=' +
                                    std::to_string(
                                      holds * std::stod(file.given(entry)))}),
                                 communicator),
              1e-9);
          }
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        State     &state      = simulation->run.state;

        double first_millimetre = 0., largest = 0.;
        Mass   mass;
        for (unsigned int cycle = 1; cycle <= cycles; ++cycle)
          {
            while (state.time < rest + cycle)
              {
                simulation->run.scheme.step(state);
                const double now = slip(*simulation);
                keep_largest(largest, std::abs(now));
                if (first_millimetre == 0. && std::abs(now) > 1e-3)
                  first_millimetre = state.time - rest;
                advance(mass, state.time - rest);
              }
            const std::string name = "cycle " + std::to_string(cycle) + ": ";
            if (cycle == 1)
              verdicts.near("first millimetre of slip [s]",
                            first_millimetre,
                            mass.first_millimetre,
                            0.005);
            verdicts.near(name + "largest slip [mm]",
                          1e3 * largest,
                          1e3 * mass.largest,
                          0.005);
            // the block is elastic, the point mass is rigid
            verdicts.near(name + "slip at the end [mm]",
                          1e3 * slip(*simulation),
                          1e3 * mass.x,
                          0.025);
          }
        verdicts.below("penetration over cell size",
                       simulation->run.contact->effort().penetration /
                         simulation->run.contact->cell_size(),
                       1e-10);
      }

    private:
      static constexpr double gravity = 9.81, amplitude = 0.5 * gravity,
                              rest = 0.1; // before the shaking [s]

      /** Slip of the block, mean over its base. */
      double
      slip(const Simulation &simulation) const
      {
        std::vector<double> sums(2);
        for (const ContactPoint &point : simulation.run.contact->points())
          {
            sums[0] += point.area * (point.gap * point.frame)[direction];
            sums[1] += point.area;
          }
        sums = sum_over_ranks(sums, simulation.model.grid.communicator());
        return sums[0] / sums[1];
      }

      /** Largest slip of a case in its first cycle. */
      double
      largest_slip(const ParameterFile &file, const MPI_Comm communicator) const
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        double     largest    = 0.;
        while (simulation->run.state.time < rest + 1.)
          {
            simulation->run.scheme.step(simulation->run.state);
            keep_largest(largest, std::abs(slip(*simulation)));
          }
        return largest;
      }

      /** A point mass on the plane. */
      struct Mass
      {
        double t = 0., v = 0., x = 0., largest = 0., first_millimetre = 0.;
        bool   broken = false;
      };

      /** Integrates the motion of the mass in small steps. */
      void
      advance(Mass &mass, const double end) const
      {
        constexpr double dt = 2e-6, omega = 2. * numbers::PI;
        for (; mass.t < end; mass.t += dt)
          {
            const double base =
              amplitude * std::sin(omega * (mass.t + 0.5 * dt));
            const double drive = push - base,
                         rubs  = friction * (gravity + vertical * base);
            const double limit = rubs + (mass.broken ? 0. : cohesion);
            if (mass.v == 0. && std::abs(drive) <= limit)
              continue;
            mass.broken       = true;
            const double sign = mass.v != 0. ? mass.v : drive;
            double next = mass.v + dt * (drive - std::copysign(rubs, sign));
            if (mass.v * next < 0.)
              next = 0.; // the mass stops within the step
            mass.x += 0.5 * dt * (mass.v + next);
            mass.v = next;
            keep_largest(mass.largest, std::abs(mass.x));
            if (mass.first_millimetre == 0. && mass.largest > 1e-3)
              mass.first_millimetre = mass.t;
          }
      }

      double       push = 0., friction = 0.3, cohesion = 0., vertical = 0.;
      unsigned int direction = 0, cycles = 3;
    };

    // Reference: other program
    const Registry<Check>::Add<Newmark>
      registered("contact newmark", "A block that slides on a shaken plane.");
  } // namespace
} // namespace Voussoir
