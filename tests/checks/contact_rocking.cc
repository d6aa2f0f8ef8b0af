#include <voussoir/base/mpi.h>

#include "contact_sums.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A slender block of width b and height h that rocks from edge to edge
     * under its weight (Housner 1963), at angles so small that the restoring
     * moment m g b/2 is constant: the time from an impact to the next is T = 2
     * sqrt(2 theta I / (m g b / 2)) , I = m (b^2 + h^2) / 3 , with theta the
     * largest angle of the motion. An impact dissipates energy and never
     * supplies any: Housner's impact, on the other edge alone, leaves the share
     * r = 1 - 3/2 b^2 / (b^2 + h^2) of the angular velocity. An elastic block
     * keeps more or less, as waves in it interfere.
     */
    class Rocking : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Width", width, "[m].");
        prm.add_parameter("Height", height, "Height of the block [m].");
        prm.add_parameter("Base", base, "Elevation of the joint [m].");
        prm.add_parameter("Angular velocity", rate, "At the start [1/s].");
        prm.add_parameter("Ways", ways, "From impact to impact, to compare.");
        prm.add_parameter("On edges",
                          on_edges,
                          "Whether it touches its base there only, as "
                          "Housner's block.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        State     &state      = simulation->run.state;
        start(*simulation);

        std::vector<double> largest(1, 0.), duration;
        double              begin = state.time, before = 0.;
        while (duration.size() < ways && state.time < parameters->time.end_time)
          {
            simulation->run.scheme.step(state);
            const double angle = mean_motion(*simulation)[0] / (0.5 * height);
            if (angle * before < 0.)
              {
                // where the line between the two steps is at zero
                const double now =
                  state.time -
                  simulation->run.time_step.length * angle / (angle - before);
                duration.push_back(now - begin);
                begin = now;
                largest.push_back(0.);
              }
            before = angle;
            keep_largest(largest.back(), std::abs(angle));
          }
        verdicts.is_true("all ways are there", duration.size() == ways);

        const double inertia = (width * width + height * height) / 3.;
        double       gained  = -1.;
        for (unsigned int i = 0; i < duration.size(); ++i)
          {
            verdicts.near("way " + std::to_string(i + 1) + ": its time [ms]",
                          1e3 * duration[i],
                          2e3 * std::sqrt(2. * largest[i] * inertia /
                                          (0.5 * gravity * width)),
                          0.03);
            if (i > 0)
              keep_largest(gained, largest[i] / largest[i - 1] - 1.);
          }
        verdicts.near("first way: largest angle [mrad]",
                      1e3 * largest[0],
                      1e3 * 0.5 * rate * rate * inertia /
                        (0.5 * gravity * width),
                      0.03);
        // the duration of a half cycle is proportional to the angular velocity
        // at its beginning
        if (on_edges && duration.size() == ways)
          verdicts.near("angular velocity after an impact over that before",
                        std::pow(duration.back() / duration.front(),
                                 1. / (ways - 1.)),
                        1. - 1.5 * width * width /
                               (width * width + height * height),
                        0.01);
        verdicts.below("energy gained by an impact, over that before",
                       positive_part(gained),
                       0.);
      }

    private:
      static constexpr double gravity = 9.81;

      /** The block turns about its edge at x = width. */
      void
      start(Simulation &simulation) const
      {
        const auto &discretization = simulation.model.solid.discretization;
        State      &state          = simulation.run.state;
        for (const auto &cell :
             discretization.dof_handler.active_cell_iterators())
          if (!cell->is_artificial() && cell->center()[2] > base)
            for (const auto global : discretization.cell_nodes(cell))
              if (discretization.owned_dofs.is_element(3 * global))
                {
                  const unsigned int node = discretization.owned_node(global);
                  const Point<3>    &x    = discretization.node_positions[node];
                  state.velocity.local_element(3 * node) = rate * (x[2] - base);
                  state.velocity.local_element(3 * node + 2) =
                    rate * (width - x[0]);
                }
        simulation.run.contact->start(state);
      }

      double       width = 1., height = 4., base = 0.5, rate = 0.1;
      unsigned int ways     = 4;
      bool         on_edges = false;
    };

    // Reference: closed form
    const Registry<Check>::Add<Rocking>
      registered("contact rocking", "A block that rocks on its base.");
  } // namespace
} // namespace Voussoir
