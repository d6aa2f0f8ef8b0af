#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A block that is compressed in z and stretched in x, each time from its
     * initial state: its forces change with the stretch without a jump, also
     * where the direction of the crack that would open changes between x and z.
     * Half the step of the stretch gives half the largest change of the forces,
     * unless they jump. The search for static equilibrium needs this
     * continuity.
     */
    class ContinuousResponse : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Pressed", pressed, "Strain in z, shortening [1].");
        prm.add_parameter("Stretched", stretched, "Largest strain in x [1].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto   parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const Change coarse     = largest_change(*simulation, 500),
                     fine       = largest_change(*simulation, 1000);
        verdicts.above("cracked, damage during the motion",
                       coarse.damaged,
                       0.5);
        verdicts.near("largest change of half a step over that of one",
                      fine.largest / coarse.largest,
                      0.5,
                      0.05,
                      "");
      }

    private:
      struct Change
      {
        double largest; // of the forces from a step of the stretch to the next
        double damaged; // share of the steps
      };

      Change
      largest_change(const Simulation &simulation, const unsigned int n) const
      {
        const InternalForce &internal_force =
          simulation.run.equation.internal_force;
        const Discretization &discretization =
          simulation.model.solid.discretization;
        Vector u = discretization.create_vector(), force(u), before(u);
        Change change{0., 0.};
        for (unsigned int i = 0; i <= n; ++i)
          {
            for (unsigned int node = 0; node < discretization.n_owned_nodes();
                 ++node)
              {
                const Point<3> &p         = discretization.node_positions[node];
                u.local_element(3 * node) = stretched * i / n * p[0];
                u.local_element(3 * node + 2) = -pressed * p[2];
              }
            MaterialMemory memory = internal_force.new_memory();
            internal_force.respond(force, u, memory);
            if (memory.losses().material > 0.)
              change.damaged += 1. / (n + 1);
            before -= force;
            if (i > 0)
              keep_largest(change.largest, before.l2_norm());
            before = force;
          }
        return change;
      }

      double pressed = 0., stretched = 0.;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<ContinuousResponse>
      registered("continuous response",
                 "Stress of concrete that is pressed and stretched.");
  } // namespace
} // namespace Voussoir
