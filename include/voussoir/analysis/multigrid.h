#ifndef voussoir_analysis_multigrid_h
#define voussoir_analysis_multigrid_h

#include <voussoir/fem/discretization.h>

#include <deal.II/base/subscriptor.h>
#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <Epetra_MultiVector.h>

#include <functional>

struct ML_Struct; // of Trilinos

namespace Voussoir
{
  /**
   * A multigrid cycle whose finest level is a matrix-free operator, with
   * Chebyshev smoothing by its diagonal (Adams et al. 2003); the coarser levels
   * are Trilinos' smoothed aggregation of a matrix that is spectrally
   * equivalent. Products with that matrix would take most of the time, so that
   * it is freed once the coarser levels are made.
   */
  class Multigrid
  {
  public:
    /** dst = A src, symmetric and zero on entries that are constrained. */
    using Operator = std::function<void(Vector &dst, const Vector &src)>;

    /**
     * @param apply    on the finest level
     * @param matrix with arbitrary entries where fixed; afterwards empty,
     *   unless it is so small that it is the only level
     * @param diagonal of the matrix
     * @param constrained     owned entries
     * @param n_components of a node, whose entries follow each other
     * @param near_kernel the motions without energy of a free body
     */
    Multigrid(const Operator                         &apply,
              dealii::TrilinosWrappers::SparseMatrix &matrix,
              const Vector                           &diagonal,
              const std::vector<unsigned int>        &constrained,
              const unsigned int                      n_components,
              const Epetra_MultiVector               &near_kernel);

    /** One cycle from zero. */
    void
    vmult(Vector &dst, const Vector &src) const;

  private:
    struct FinestLevel : public dealii::Subscriptor
    {
      FinestLevel(const Operator                       &apply,
                  const dealii::types::global_dof_index size)
        : apply(apply)
        , size(size)
      {}

      void
      vmult(Vector &dst, const Vector &src) const
      {
        apply(dst, src);
      }

      // the smoother needs these, too
      dealii::types::global_dof_index
      m() const
      {
        return size;
      }

      double
      el(const dealii::types::global_dof_index,
         const dealii::types::global_dof_index) const
      {
        AssertThrow(false, dealii::ExcNotImplemented());
        return 0.;
      }

      Operator                        apply;
      dealii::types::global_dof_index size;
    };

    using Smoother =
      dealii::PreconditionChebyshev<FinestLevel,
                                    Vector,
                                    dealii::DiagonalMatrix<Vector>>;

    /** dst += correction by the coarser levels for the residual. */
    void
    correct(Vector &dst, const Vector &residual) const;

    FinestLevel                               finest;
    const std::vector<unsigned int>          &constrained;
    Smoother                                  smoother;
    dealii::TrilinosWrappers::PreconditionAMG coarser;
    ML_Struct                                *levels = nullptr; // of `coarser`
    bool                        single_level = false; // which is solved at once
    mutable Vector              residual, change;
    mutable std::vector<double> coarse_residual, coarse_change;
  };
} // namespace Voussoir

#endif
