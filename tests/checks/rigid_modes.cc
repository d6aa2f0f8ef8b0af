#include <deal.II/lac/lapack_full_matrix.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The eigenvalues of the stiffness of a small body without supports: six of
     * its motions are rigid, with the eigenvalue zero. All others have positive
     * eigenvalues; with one point these are at most those of full integration,
     * and not much lower: in a cube, where the strain varies along two
     * directions, E/(M + 2 G) of them.
     */
    class RigidModes : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Ratio", ratio, "Smallest one allowed.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto one = eigenvalues(file, verdicts, communicator);
        const auto full =
          eigenvalues(file.with({"Discretization/Quadrature=Gauss"}),
                      verdicts,
                      communicator);
        unsigned int rigid = 0;
        while (std::abs(one[rigid]) < 1e-12 * one.back())
          ++rigid;
        verdicts.near("motions without energy", rigid, 6, 0.);
        double smallest = 1., largest = 0.;
        for (unsigned int i = 6; i < one.size(); ++i)
          {
            keep_smallest(smallest, one[i] / full[i]);
            keep_largest(largest, one[i] / full[i]);
          }
        verdicts.above("smallest ratio of the others to full integration",
                       smallest,
                       ratio);
        verdicts.is_true("none is larger", largest < 1. + 1e-9);
      }

    private:
      /** In ascending order. */
      std::vector<double>
      eigenvalues(const ParameterFile &file,
                  Verdicts            &verdicts,
                  const MPI_Comm       communicator) const
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        Vector     u = simulation->model.solid.discretization.create_vector(),
               force = u;
        const unsigned int       n = u.size();
        LAPACKFullMatrix<double> matrix(n);
        double                   asymmetry = 0.;
        for (unsigned int j = 0; j < n; ++j)
          {
            u    = 0.;
            u[j] = 1.;
            simulation->run.equation.internal_force.apply(force, u);
            for (unsigned int i = 0; i < n; ++i)
              {
                matrix(i, j) = force[i];
                if (i < j)
                  keep_largest(asymmetry,
                               std::abs(matrix(i, j) - matrix(j, i)));
              }
          }
        const double size = matrix.linfty_norm();
        verdicts.below("asymmetry of the stiffness", asymmetry / size, 1e-14);

        dealii::Vector<double> values;
        FullMatrix<double>     vectors;
        matrix.compute_eigenvalues_symmetric(
          -size, 2. * size, 1e-14 * size, values, vectors);
        return {values.begin(), values.end()};
      }

      double ratio = 0.2;
    };

    // Reference: closed form
    const Registry<Check>::Add<RigidModes>
      registered("rigid modes", "No other motion without energy.");
  } // namespace
} // namespace Voussoir
