#include <voussoir/analysis/block.h>
#include <voussoir/analysis/eigensolver.h>
#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <cmath>
#include <limits>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int max_iterations = 500;

    // Directions of unit energy are dropped if their part orthogonal to the
    // others is smaller than the root of this.
    constexpr double dependent = 1e-12;


    /** Eigenvalues between two bounds in ascending order, with the vectors in
     *  columns. */
    std::pair<dealii::Vector<double>, FullMatrix<double>>
    eigenpairs(const FullMatrix<double> &matrix,
               const double              lower,
               const double              upper)
    {
      LAPACKFullMatrix<double> copy(matrix.m());
      copy = matrix;
      std::pair<dealii::Vector<double>, FullMatrix<double>> result;
      // this accuracy makes LAPACK's dsyevx most accurate
      copy.compute_eigenvalues_symmetric(lower,
                                         upper,
                                         2. *
                                           std::numeric_limits<double>::min(),
                                         result.first,
                                         result.second);
      return result;
    }


    /** The stationary points of x^T M x / x^T K x in a subspace. */
    struct Ritz
    {
      std::vector<double> values;       // from the largest down
      FullMatrix<double>  coefficients; // of vectors with x^T K x = 1
    };


    /**
     * @param stiffness,mass products of the directions; not empty
     * @param number of pairs wanted; there are fewer if the directions are
     * linearly dependent
     */
    Ritz
    find_ritz_pairs(const FullMatrix<double> &stiffness,
                    const FullMatrix<double> &mass,
                    const unsigned int        number)
    {
      const unsigned int n = stiffness.m();
      FullMatrix<double> k(n), m(n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          {
            const double scale =
              1. / std::sqrt(stiffness(i, i) * stiffness(j, j));
            k(i, j) = scale * stiffness(i, j);
            m(i, j) = scale * mass(i, j);
          }
      Ritz result;
      if (!std::isfinite(k.frobenius_norm() + m.frobenius_norm()))
        return result;

      // directions of unit energy that are orthogonal in the energy
      auto [energies, basis]   = eigenpairs(k, dependent, 2. * n);
      const unsigned int n_own = energies.size();
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n_own; ++j)
          basis(i, j) /= std::sqrt(energies[j]);
      FullMatrix<double> product(n, n_own), own_mass(n_own);
      m.mmult(product, basis);
      basis.Tmmult(own_mass, product);

      const double size = own_mass.frobenius_norm();
      const auto [values, vectors] =
        eigenpairs(own_mass, -2. * size, 2. * size);
      const unsigned int n_pairs = std::min(number, n_own);
      result.coefficients.reinit(n, n_pairs);
      for (unsigned int p = 0; p < n_pairs; ++p)
        {
          const unsigned int from = values.size() - 1 - p;
          result.values.push_back(values[from]);
          for (unsigned int i = 0; i < n; ++i)
            {
              for (unsigned int j = 0; j < n_own; ++j)
                result.coefficients(i, p) += basis(i, j) * vectors(j, from);
              result.coefficients(i, p) /= std::sqrt(stiffness(i, i));
            }
        }
      return result;
    }


    /** The same numbers on all ranks, to the last bit. */
    void
    agree(Ritz &ritz, const MPI_Comm communicator)
    {
      ritz.values = Utilities::MPI::broadcast(communicator, ritz.values);
      ritz.coefficients =
        Utilities::MPI::broadcast(communicator, ritz.coefficients);
    }


    /** Vectors and their products with both matrices. */
    struct Directions
    {
      Directions(const std::size_t size, const unsigned int n)
        : itself(size, n)
        , stiffness(size, n)
        , mass(size, n)
      {}

      Block itself, stiffness, mass;
    };


    class Iteration
    {
    public:
      Iteration(const Eigenproblem                &problem,
                std::vector<std::vector<double>> &&start,
                const unsigned int                 number,
                const double                       tolerance);

      /** Returns whether the pairs have converged. */
      bool
      run();

      std::vector<double> theta;
      Directions          x; // the approximations
      unsigned int        iterations = 0;

    private:
      /** Finds which vectors have not converged. */
      void
      find_active();

      /** Preconditioned residuals of the active vectors. */
      void
      find_corrections();

      /** The best vectors in the span of x, w and p; returns whether there are
       *  as many as before. */
      bool
      improve();

      Columns
      columns(Block Directions::*const part, const bool with_x = true);

      const Eigenproblem       &problem;
      const unsigned int        number;
      const double              tolerance;
      Directions                w, p; // corrections, last changes
      unsigned int              n_w = 0, n_p = 0;
      std::vector<unsigned int> active;
      unsigned int              n_found          = 0; // of those wanted
      double                    largest_residual = 0.;
    };


    Iteration::Iteration(const Eigenproblem                &problem,
                         std::vector<std::vector<double>> &&start,
                         const unsigned int                 number,
                         const double                       tolerance)
      : x(problem.size, start.size())
      , problem(problem)
      , number(number)
      , tolerance(tolerance)
      , w(problem.size, start.size())
      , p(problem.size, start.size())
    {
      for (unsigned int j = 0; j < start.size(); ++j)
        {
          std::copy(start[j].begin(), start[j].end(), x.itself[j]);
          start[j] = {};
          problem.stiffness(x.stiffness[j], x.itself[j]);
          problem.mass(x.mass[j], x.itself[j]);
        }
      theta.resize(start.size());
    }


    Columns
    Iteration::columns(Block Directions::*const part, const bool with_x)
    {
      Columns result;
      for (unsigned int j = 0; with_x && j < theta.size(); ++j)
        result.push_back((x.*part)[j]);
      for (unsigned int j = 0; j < n_w; ++j)
        result.push_back((w.*part)[j]);
      for (unsigned int j = 0; j < n_p; ++j)
        result.push_back((p.*part)[j]);
      return result;
    }


    void
    Iteration::find_active()
    {
      std::vector<double> squares(2 * theta.size());
      for (unsigned int j = 0; j < theta.size(); ++j)
        for (std::size_t i = 0; i < problem.size; ++i)
          {
            const double k = x.stiffness[j][i], r = x.mass[j][i] - theta[j] * k;
            squares[2 * j] += r * r;
            squares[2 * j + 1] += k * k;
          }
      squares = sum_over_ranks(squares, problem.communicator);
      active.clear();
      n_found          = number;
      largest_residual = 0.;
      for (unsigned int j = 0; j < theta.size(); ++j)
        {
          const double residual =
            std::sqrt(squares[2 * j] / squares[2 * j + 1]) / theta[j];
          if (residual <= tolerance)
            continue;
          active.push_back(j);
          if (j >= number)
            continue;
          --n_found;
          largest_residual = std::max(largest_residual, residual);
        }
    }


    void
    Iteration::find_corrections()
    {
      std::vector<double> residual(problem.size);
      n_w = 0;
      for (const unsigned int j : active)
        {
          for (std::size_t i = 0; i < problem.size; ++i)
            residual[i] = x.mass[j][i] - theta[j] * x.stiffness[j][i];
          problem.precondition(w.itself[n_w], residual.data());
          problem.stiffness(w.stiffness[n_w], w.itself[n_w]);
          problem.mass(w.mass[n_w], w.itself[n_w]);
          ++n_w;
        }
    }


    bool
    Iteration::improve()
    {
      const std::size_t size = x.itself.padded_size();
      const Columns     all  = columns(&Directions::itself);
      Ritz              ritz =
        find_ritz_pairs(symmetric_products(all,
                                           columns(&Directions::stiffness),
                                           size,
                                           problem.communicator),
                        symmetric_products(all,
                                           columns(&Directions::mass),
                                           size,
                                           problem.communicator),
                        theta.size());
      agree(ritz, problem.communicator);
      if (ritz.values.size() < theta.size())
        return false;
      theta = ritz.values;

      // the new p are the active vectors' changes, without their part in x
      const unsigned int n_x = theta.size(), n_active = active.size();
      FullMatrix<double> c(all.size(), n_x + n_active);
      for (unsigned int i = 0; i < all.size(); ++i)
        {
          for (unsigned int j = 0; j < n_x; ++j)
            c(i, j) = ritz.coefficients(i, j);
          for (unsigned int j = 0; i >= n_x && j < n_active; ++j)
            c(i, n_x + j) = ritz.coefficients(i, active[j]);
        }
      for (const auto part :
           {&Directions::itself, &Directions::stiffness, &Directions::mass})
        {
          Columns targets;
          for (unsigned int j = 0; j < n_x; ++j)
            targets.push_back((x.*part)[j]);
          for (unsigned int j = 0; j < n_active; ++j)
            targets.push_back((p.*part)[j]);
          combine(targets, columns(part), c, size);
        }
      n_p = n_active;
      return true;
    }


    bool
    Iteration::run()
    {
      for (; iterations < max_iterations && improve(); ++iterations)
        {
          find_active();
          if (n_found == number)
            return true;
          if (problem.watch)
            problem.watch(iterations + 1, n_found, largest_residual);
          find_corrections();
        }
      return false;
    }
  } // namespace


  Eigenpairs
  find_lowest(const Eigenproblem                &problem,
              std::vector<std::vector<double>> &&start,
              const unsigned int                 number,
              const double                       tolerance)
  {
    Iteration iteration(problem, std::move(start), number, tolerance);
    if (!iteration.run())
      throw UserError("The natural modes do not converge, as when a part of "
                      "the model can move freely; fix it with \"Fixed\" or "
                      "\"Roller\" in section \"Boundaries\", set \"Interfaces "
                      "= all tied\" in section \"Modes\" if open interfaces "
                      "detach it, or ask for fewer modes there.");

    Eigenpairs result;
    result.iterations = iteration.iterations;
    std::vector<double> stiffness(problem.size), mass(problem.size);
    for (unsigned int j = 0; j < number; ++j)
      {
        const double        theta = iteration.theta[j];
        const double       *from  = iteration.x.itself[j];
        std::vector<double> x(from, from + problem.size);
        for (double &entry : x) // from x^T K x = 1
          entry /= std::sqrt(theta);
        problem.stiffness(stiffness.data(), x.data());
        problem.mass(mass.data(), x.data());
        std::vector<double> squares(2);
        for (std::size_t i = 0; i < problem.size; ++i)
          {
            squares[0] +=
              Utilities::fixed_power<2>(stiffness[i] - mass[i] / theta);
            squares[1] += stiffness[i] * stiffness[i];
          }
        squares = sum_over_ranks(squares, problem.communicator);
        result.values.push_back(1. / theta);
        result.residuals.push_back(std::sqrt(squares[0] / squares[1]));
        result.vectors.push_back(std::move(x));
      }
    return result;
  }
} // namespace Voussoir
