#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A box set in motion and left alone keeps its discrete energy. */
    class EnergyKept : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        State     &state      = simulation->run.state;
        const auto shape      = [](const Point<3> &p, const unsigned int d) {
          return std::sin(0.11 * p[0] + 0.07 * p[1] + 0.13 * p[2] + d);
        };
        for (unsigned int node = 0;
             node < simulation->model.solid.discretization.n_owned_nodes();
             ++node)
          for (unsigned int d = 0; d < 3; ++d)
            if (simulation->model.solid.mass.inverse.local_element(3 * node +
                                                                   d) > 0.)
              state.velocity.local_element(3 * node + d) = shape(
                simulation->model.solid.discretization.node_positions[node], d);

        double first = 0., smallest = 1e300, largest = 0., swing = 0.;
        for (unsigned int step = 0; step < 400; ++step)
          {
            simulation->run.scheme.step(state);
            if (step % 10 == 0)
              {
                const EnergyTerms &terms =
                  simulation->run.energy.evaluate(state);
                if (step == 0)
                  first = terms.stored();
                keep_smallest(smallest, terms.stored());
                keep_largest(largest, terms.stored());
                keep_largest(swing, terms.strain / first);
              }
          }
        verdicts.above("largest share of strain energy", swing, 0.05);
        verdicts.below("change of the discrete energy over itself",
                       (largest - smallest) / first,
                       1e-10);
        if (parameters->grid.local_refinement.empty() == false)
          verdicts.is_true(
            "the mesh has hanging nodes",
            Utilities::MPI::sum(simulation->model.solid.discretization
                                  .hanging_nodes.n_constraints(),
                                communicator) > 0);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<EnergyKept>
      registered("energy kept",
                 "Discrete energy of an undriven, undamped box.");
  } // namespace
} // namespace Voussoir
