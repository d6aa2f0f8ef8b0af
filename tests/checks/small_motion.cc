#include <deal.II/base/patterns.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A motion that is many times smaller is computed as accurately: the
     *  energy balance closes, and without cracks and joints the motion is
     *  proportional to the larger one.
     */
    class SmallMotion : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Sizes",
                          sizes,
                          "Factors on the load; the first is 1.");
        prm.add_parameter("Time function",
                          time_function,
                          "Time function of the load \"push\" of size 1.");
        prm.add_parameter(
          "Linear",
          linear,
          "Whether the model is linear, without cracks and slip.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        Vector of_first;
        for (const double size : sizes)
          {
            const std::string text = Patterns::Tools::to_string(size);
            const auto        parameters =
              make_case(file.with({"Loads/push/Time function=" + text + "*(" +
                                   time_function + ")"}));
            const auto simulation = make_simulation(*parameters, communicator);
            Run       &run        = simulation->run;
            run.march();
            verdicts.below("size " + text + ": largest energy-balance error",
                           run.energy.summary().largest_error,
                           0.01); // as a run warns
            if (!linear)
              continue;
            Vector u = run.state.displacement;
            u *= 1. / size;
            if (of_first.size() == 0)
              of_first = u;
            u -= of_first;
            verdicts.below("  motion, apart from that of size 1 in small",
                           u.linfty_norm() / of_first.linfty_norm(),
                           1e-6);
          }
      }

    private:
      std::vector<double> sizes;
      std::string         time_function;
      bool                linear = true;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<SmallMotion> registered("small motion",
                                                       "Motions of any size.");
  } // namespace
} // namespace Voussoir
