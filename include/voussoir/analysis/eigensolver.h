#ifndef voussoir_analysis_eigensolver_h
#define voussoir_analysis_eigensolver_h

#include <mpi.h>

#include <functional>
#include <vector>

namespace Voussoir
{
  /**
   * K x = lambda M x with a positive definite stiffness K and a mass M that may
   * be singular. The three operators map (result, vector), of which each rank
   * has `size` entries, and keep constrained entries at zero.
   */
  struct Eigenproblem
  {
    using Operator = std::function<void(double *, const double *)>;

    Operator    stiffness, mass;
    Operator    precondition; // an approximation of K^-1
    std::size_t size;         // entries of this rank
    MPI_Comm    communicator;

    /** Called after each iteration on all ranks: iterations so far, wanted
     * eigenpairs that have converged, largest residual of the others. */
    std::function<void(unsigned int, unsigned int, double)> watch;
  };

  /** Eigenpairs from the lowest eigenvalue upwards. */
  struct Eigenpairs
  {
    std::vector<double>              values;
    std::vector<std::vector<double>> vectors;   // x^T M x = 1
    std::vector<double>              residuals; // |K x - lambda M x| / |K x|
    unsigned int                     iterations = 0;
  };

  /**
   * The lowest eigenpairs by locally optimal block preconditioned conjugate
   * gradients (LOBPCG, Knyazev 2001). The iteration works on M x = theta K x,
   * theta = 1/lambda, with K as the inner product, so that entries without mass
   * do no harm. Converged vectors get no more corrections, and linearly
   * dependent directions are dropped.
   *
   * @param start     the block to begin with, some vectors more than wanted
   * @param number    eigenpairs wanted
   * @param tolerance largest residual of each; UserError if 500 iterations do
   *   not reach it
   */
  Eigenpairs
  find_lowest(const Eigenproblem                &problem,
              std::vector<std::vector<double>> &&start,
              const unsigned int                 number,
              const double                       tolerance);
} // namespace Voussoir

#endif
