#include <voussoir/base/mpi.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A block with water on one vertical side, on rollers that let it move
     * along y only: pressure resultant on a rigid wall 7/12 rho a H^2 per
     * width, and a rigid block driven by a force moves by F / (m + m_a).
     */
    class AddedMass : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Depth", depth, "Depth of the water [m].");
        prm.add_parameter("Width", width, "Width of the wall [m].");
        prm.add_parameter("Mass", mass, "Mass of the block [kg].");
        prm.add_parameter("Force", force, "On the block [N].");
        prm.add_parameter("Tolerance", tolerance, "On the resultant.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters   = make_case(file);
        const auto simulation   = make_simulation(*parameters, communicator);
        const NodalTerms &terms = simulation->model.terms;

        const double       expected = 7. / 12. * 1000. * depth * depth * width;
        NodalTerms::Matrix sum;
        for (const auto &matrix : terms.added_mass)
          sum += matrix;
        sum = Utilities::MPI::sum(sum, communicator);
        verdicts.near("added mass in y over 7/12 rho H^2",
                      sum[1][1],
                      expected,
                      tolerance,
                      "kg");
        verdicts.below("added mass across over that along",
                       std::abs(sum[0][0] + sum[2][2]) / sum[1][1],
                       1e-12);

        // from rest under a constant force, as a rigid body
        while (simulation->run.state.time < parameters->time.end_time)
          simulation->run.scheme.step(simulation->run.state);
        double momentum = 0.;
        for (unsigned int i = 1;
             i < simulation->run.state.velocity.locally_owned_size();
             i += 3)
          momentum += simulation->run.state.velocity.local_element(i) *
                      simulation->model.solid.mass.mass.local_element(i);
        momentum = Utilities::MPI::sum(momentum, communicator);
        const double time =
          simulation->run.state.time - 0.5 * simulation->run.time_step.length;
        verdicts.near("mean velocity [m/s]",
                      momentum / mass,
                      force * time / (mass + sum[1][1]),
                      0.02);
        verdicts.below("energy-balance error",
                       (simulation->run.energy.evaluate(simulation->run.state),
                        simulation->run.energy.relative_error()),
                       1e-9);
      }

    private:
      double depth = 1., width = 1., mass = 1., force = 1., tolerance = 0.01;
    };

    // Reference: closed form
    const Registry<Check>::Add<AddedMass>
      registered("added mass", "Westergaard's added mass on a rigid block.");
  } // namespace
} // namespace Voussoir
