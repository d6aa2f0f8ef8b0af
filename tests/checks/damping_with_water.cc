#include "check.h"
#include "momentum.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A wall with added mass that is released in one of the natural modes to
     * which Rayleigh damping is fitted: with C = alpha (M + M_a) + beta K its
     * motion decays with the given ratio, in this mode alone.
     */
    class DampingWithWater : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const unsigned int mode : {1, 2})
          {
            const auto  parameters = make_case(file);
            const auto  simulation = make_simulation(*parameters, communicator);
            const Mode &natural    = simulation->modes.list.at(mode - 1);
            const std::string name = "mode " + std::to_string(mode);
            const Vector      momentum =
              momentum_with_water(simulation->model, natural.shape);
            Vector of_wall(natural.shape);
            of_wall.scale(simulation->model.solid.mass.mass);
            const double total = momentum * natural.shape;
            verdicts.above(name + ": share of the water in its mass",
                           1. - of_wall * natural.shape / total,
                           0.3);

            State &state   = simulation->run.state;
            state.velocity = natural.shape;
            verdicts.near(name + ": damping ratio [%]",
                          100. * decay(*simulation, momentum),
                          100. * parameters->damping.ratio,
                          0.01);
          }
      }

    private:
      /** Ratio by the peaks of the projection on the mode. */
      static double
      decay(Simulation &simulation, const Vector &momentum)
      {
        std::vector<double> peaks;
        double              before = 0., now = 0.;
        while (peaks.size() < 6)
          {
            simulation.run.scheme.step(simulation.run.state);
            const double after = simulation.run.state.displacement * momentum;
            if (now > before && now >= after && now > 0.)
              {
                const double shift =
                  0.5 * (before - after) / (before - 2. * now + after);
                peaks.push_back(now - 0.25 * (before - after) * shift);
              }
            before = now;
            now    = after;
          }
        const double decrement =
          std::log(peaks.front() / peaks.back()) / (5. * 2. * numbers::PI);
        return decrement / std::sqrt(1. + decrement * decrement);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<DampingWithWater>
      registered("damping with water", "Decay of modes with added mass.");
  } // namespace
} // namespace Voussoir
