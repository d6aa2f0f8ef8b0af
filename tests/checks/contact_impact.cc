#include <voussoir/base/mpi.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A bar that hits another one at rest, or a rigid wall, at 1 m/s: stress
     * rho c v / 2 (rho c v) for the time 2 L / c in which the wave runs forth
     * and back, then the first bar rests and the other one moves (it rebounds).
     */
    class Impact : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Length", length, "Length of a bar [m].");
        prm.add_parameter("Contact at", contact_at, "Elevation [m].");
        prm.add_parameter("Wall", wall, "The lower bar is fixed.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto  parameters     = make_case(file);
        const auto  simulation     = make_simulation(*parameters, communicator);
        const auto &discretization = simulation->model.solid.discretization;
        State      &state          = simulation->run.state;
        const auto  upper          = [&](const unsigned int node) {
          // the nodes at the contact belong to the bar they are in
          return is_upper[node];
        };
        is_upper.assign(discretization.n_owned_nodes(), false);
        for (const auto &cell :
             discretization.dof_handler.active_cell_iterators())
          if (!cell->is_artificial() && cell->center()[2] > contact_at)
            for (const auto node : discretization.cell_nodes(cell))
              if (discretization.owned_dofs.is_element(3 * node))
                is_upper[discretization.owned_node(node)] = true;
        for (unsigned int node = 0; node < is_upper.size(); ++node)
          if (upper(node))
            state.velocity.local_element(3 * node + 2) = -1.;
        simulation->run.contact->start(state);

        // E = 30 GPa, nu = 0, rho = 2400 kg/m3
        const double density = 2400., speed = std::sqrt(30e9 / density);
        const double stress       = density * speed * (wall ? 1. : 0.5);
        const double duration     = 2. * length / speed,
                     dt           = simulation->run.time_step.length;
        const double section      = 0.01,
                     start_energy = 0.5 * density * length * section;
        double       error = 0., impulse = 0., separation = 0., work = 0.;
        unsigned int samples = 0;
        while (state.time < parameters->time.end_time)
          {
            simulation->run.scheme.step(state);
            std::vector<double> sums(2);
            for (const ContactPoint &point : simulation->run.contact->points())
              {
                sums[0] += point.force[0];
                sums[1] += point.area;
              }
            sums = sum_over_ranks(sums, communicator);
            impulse += dt * sums[0] / section;
            if (sums[0] > 0.)
              separation = state.time;
            if (state.time > 0.1 * duration && state.time < 0.9 * duration)
              {
                error += sums[0] / sums[1] / stress - 1.;
                ++samples;
              }
          }
        work = Utilities::MPI::sum(
          double(simulation->run.state.accounts.work_of_projections),
          communicator);

        // mean velocities of the bars
        std::vector<double> momentum(4);
        for (unsigned int node = 0; node < is_upper.size(); ++node)
          {
            const double m =
              simulation->model.solid.mass.mass.local_element(3 * node + 2);
            momentum[upper(node) ? 0 : 2] +=
              m * state.velocity.local_element(3 * node + 2);
            momentum[upper(node) ? 1 : 3] += m;
          }
        momentum        = sum_over_ranks(momentum, communicator);
        const double v1 = momentum[0] / momentum[1];

        const double energy_loss = -work / start_energy;
        verdicts.near("stress while they touch [MPa]",
                      1e-6 * stress * (1. + error / samples),
                      1e-6 * stress,
                      2e-5);
        verdicts.near("impulse per area [N s / m2]",
                      impulse,
                      stress * duration,
                      0.006);
        verdicts.near("separation [ms]",
                      1e3 * separation,
                      1e3 * duration,
                      0.005);
        // the nodal masses in contact are half a cell each, and stop each other
        verdicts.near("energy lost [%]",
                      100. * energy_loss,
                      100. * simulation->run.contact->cell_size() / length *
                        (wall ? 0.5 : 0.25),
                      0.02);
        if (wall)
          verdicts.near("velocity after the rebound [m/s]", v1, 1., 0.01);
        else
          {
            verdicts.below("velocity of the first bar afterwards [m/s]",
                           v1,
                           0.01);
            verdicts.near("velocity of the second bar [m/s]",
                          momentum[2] / momentum[3],
                          -1.,
                          0.01);
          }
        verdicts.below("penetration over cell size",
                       simulation->run.contact->effort().penetration /
                         simulation->run.contact->cell_size(),
                       1e-10);
      }

    private:
      double length = 10., contact_at = 10.;
      bool   wall = false;

      std::vector<bool> is_upper; // of the owned nodes
    };

    // Reference: closed form
    const Registry<Check>::Add<Impact>
      registered("contact impact", "Bars that hit each other or a wall.");
  } // namespace
} // namespace Voussoir
