#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The reported limit of the time step: a disturbance in all modes stays
     * bounded just below it and grows just above it.
     */
    class Stability : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Steps", steps, "Number of steps.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const double below = growth(file, 0.99, communicator);
        const double above = growth(file, 1.02, communicator);
        verdicts.below("velocity at 0.99 of the limit over the first",
                       below,
                       10.);
        // a motion that has overflowed has grown, too
        verdicts.is_true("velocity at 1.02 of the limit grows over a thousand "
                         "times",
                         !(above < 1e3));
      }

    private:
      // largest velocity over the last tenth of the run over the initial one
      double
      growth(const ParameterFile &file,
             const double         factor,
             const MPI_Comm       communicator) const
      {
        const auto parameters = make_case(file);
        // in a file the factor is at most one
        parameters->time.safety_factor = factor;
        const auto simulation = make_simulation(*parameters, communicator);
        State     &state      = simulation->run.state;
        for (unsigned int node = 0;
             node < simulation->model.solid.discretization.n_owned_nodes();
             ++node)
          for (unsigned int d = 0; d < 3; ++d)
            if (simulation->model.solid.mass.inverse.local_element(3 * node +
                                                                   d) > 0.)
              {
                const Point<3> &p =
                  simulation->model.solid.discretization.node_positions[node];
                state.velocity.local_element(3 * node + d) =
                  std::sin(700. * p[0] + 1300. * p[1] + 1900. * p[2] + 2.1 * d);
              }
        const double first   = largest_entry(state.velocity);
        double       largest = 0.;
        for (unsigned int step = 0; step < steps; ++step)
          {
            simulation->run.scheme.step(state);
            if (10 * step > 9 * steps)
              keep_largest(largest, largest_entry(state.velocity));
            if (!(largest < 1e6 * first))
              return largest / first;
          }
        return largest / first;
      }

      unsigned int steps = 1500;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<Stability>
      registered("stability limit", "Bounded below, growing above the limit.");
  } // namespace
} // namespace Voussoir
