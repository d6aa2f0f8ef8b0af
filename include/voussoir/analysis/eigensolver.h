#ifndef voussoir_analysis_eigensolver_h
#define voussoir_analysis_eigensolver_h

#include <voussoir/fem/discretization.h>

namespace Voussoir
{
  /**
   * K x = lambda M x with a positive definite stiffness K and a mass M that may
   * be singular. All three map (result, vector) and keep held entries at zero.
   */
  struct Eigenproblem
  {
    using Operator = std::function<void(Vector &, const Vector &)>;

    Operator stiffness, mass;
    Operator precondition; // an approximation of K^-1
  };

  /** Eigenpairs from the lowest eigenvalue upwards. */
  struct Eigenpairs
  {
    std::vector<double> values;
    std::vector<Vector> vectors;   // x^T M x = 1
    std::vector<double> residuals; // |K x - lambda M x| / |K x|
    unsigned int        iterations = 0;
  };

  /**
   * The lowest eigenpairs by the locally optimal block preconditioned conjugate
   * gradients of Trilinos (LOBPCG). It works on M x = theta K x, theta =
   * 1/lambda, with K as the inner product, so that entries without mass do no
   * harm.
   *
   * @param start     the block to begin with, some vectors more than wanted
   * @param number    eigenpairs wanted
   * @param tolerance largest residual of each; UserError if 500 iterations do
   *   not reach it
   */
  Eigenpairs
  find_lowest(const Eigenproblem        &problem,
              const std::vector<Vector> &start,
              const unsigned int         number,
              const double               tolerance);
} // namespace Voussoir

#endif
