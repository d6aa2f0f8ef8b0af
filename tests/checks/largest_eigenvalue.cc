#include <voussoir/fem/lanczos.h>
#include <voussoir/fem/stable_step.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The largest eigenvalue where Lanczos iterations are slow to find it, and
     * a stable step where its limit jumps.
     */
    class LargestEigenvalue : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        chain(1200, verdicts);

        const auto   parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const Model &model      = simulation->model;
        const auto   step_with =
          [&](const std::function<double(const double)> &stiffening) {
            return stable_step(model.solid.discretization,
                               model.solid.internal_force,
                               model.solid.mass,
                               {stiffening, {}});
          };
        const double free = step_with([](const double) { return 0.; });
        for (const double share : {0.25, 0.5, 0.95})
          {
            const double step = step_with(
              [&](const double dt) { return dt < share * free ? 0. : 899.; });
            verdicts.near("step where the stiffness jumps, over the free one",
                          step / free,
                          share,
                          2e-5);
            verdicts.is_true("it is stable", step < share * free);
          }
        // dt = free / sqrt(1 + 3 (dt/free)^40)
        const double steep = step_with([&](const double dt) {
          return 3. * std::pow(std::min(dt / free, 2.), 40.);
        });
        const double x     = steep / free;
        verdicts.near("x^2 (1 + 3 x^40) at the limit x of a steep stiffness",
                      x * x * (1. + 3. * std::pow(x, 40.)),
                      1.,
                      1e-3);
      }

    private:
      /**
       * The matrix of Clement (1959), beside the diagonal sqrt(k (n - k)), has
       * the eigenvalues n - 1, n - 3, ..., 1 - n. From one end of it Lanczos
       * iterations reach the first rows only.
       */
      static void
      chain(const unsigned int n, Verdicts &verdicts)
      {
        Vector start(n), ones(n);
        start(0) = 1.;
        ones     = 1.;
        const double value =
          largest_eigenvalue(start, ones, [n](Vector &dst, const Vector &src) {
            const auto beside = [n](const double k) {
              return std::sqrt(k * (n - k));
            };
            for (unsigned int i = 0; i < n; ++i)
              dst(i) = (n - 1.) * src(i) +
                       (i > 0 ? beside(i) * src(i - 1) : 0.) +
                       (i + 1 < n ? beside(i + 1) * src(i + 1) : 0.);
          });
        verdicts.near("largest eigenvalue of Clement's matrix, shifted",
                      value,
                      2. * (n - 1.),
                      1e-5);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<LargestEigenvalue>
      registered("largest eigenvalue", "Of slow spectra; steps that jump.");
  } // namespace
} // namespace Voussoir
