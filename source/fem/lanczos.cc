#include <voussoir/base/error.h>
#include <voussoir/fem/lanczos.h>
#include <voussoir/fem/nodal_values.h>

#include <deal.II/lac/tridiagonal_matrix.h>

namespace Voussoir
{
  using namespace dealii;

  double
  largest_eigenvalue(const Vector &start,
                     const Vector &inverse_mass,
                     const std::function<void(Vector &, const Vector &)> &apply,
                     const bool reproducible)
  {
    const auto norm_of = [&](const Vector &x) {
      return reproducible ? std::sqrt(product(x, x, true)) : x.l2_norm();
    };
    constexpr unsigned int max_iterations = 10000;
    Vector                 root(inverse_mass); // M^-1/2
    for (double &entry : root)
      entry = std::sqrt(entry);

    Vector q(start), previous(start), w(start), scaled(start);
    for (unsigned int i = 0; i < q.locally_owned_size(); ++i)
      if (root.local_element(i) == 0.)
        q.local_element(i) = 0.;
    const double norm = norm_of(q);
    if (norm == 0.)
      return 0.; // all nodes are fixed
    q /= norm;

    std::vector<double> alpha, beta;
    double              older     = 0.;
    unsigned int        next_look = 4;
    for (unsigned int k = 0; k < max_iterations; ++k)
      {
        scaled = q;
        scaled.scale(root);
        apply(w, scaled);
        w.scale(root);
        alpha.push_back(product(w, q, reproducible));
        w.add(-alpha.back(), q);
        if (k > 0)
          w.add(-beta.back(), previous);
        beta.push_back(norm_of(w));
        if (!std::isfinite(alpha.back() + beta.back()))
          throw UserError(
            "The stiffness over the mass of the model is no "
            "finite number, so no time step can be found; check for extreme "
            "values in the sections \"Materials\" and \"Mesh\".");

        const bool exhausted = beta.back() <= 1e-12 * alpha.back();
        if (k == next_look || exhausted)
          {
            TridiagonalMatrix<double> tridiagonal(alpha.size(), true);
            for (unsigned int i = 0; i < alpha.size(); ++i)
              {
                tridiagonal(i, i) = alpha[i];
                if (i > 0)
                  tridiagonal(i, i - 1) = beta[i - 1];
              }
            tridiagonal.compute_eigenvalues();
            const double value = tridiagonal.eigenvalue(alpha.size() - 1);
            if (exhausted || (k >= 29 && value - older < 1e-6 * value))
              return value;
            older = value;
            next_look += std::max(5u, k / 50);
          }
        previous.swap(q);
        q.equ(1. / beta.back(), w);
      }
    throw UserError(
      "The largest natural frequency of the mesh, which limits "
      "the time step, is not found in 10000 iterations; check the ratio of "
      "moduli and densities in section \"Materials\", and the mesh for "
      "distorted cells.");
  }
} // namespace Voussoir
