#ifndef voussoir_analysis_multigrid_h
#define voussoir_analysis_multigrid_h

#include <voussoir/analysis/aggregates.h>

#include <deal.II/base/subscriptor.h>
#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/trilinos_precondition.h>

namespace Voussoir
{
  /**
   * A multigrid cycle whose finest level is a matrix-free operator, with
   * Chebyshev smoothing by its diagonal (Adams et al. 2003); the next one is
   * made of aggregates of a matrix that is spectrally equivalent, and the
   * coarser ones by Trilinos' smoothed aggregation. Smoothed as well, the
   * finest prolongation would take most of the memory, for a tenth fewer
   * iterations that cost more each.
   */
  class Multigrid
  {
  public:
    /** dst = A src, symmetric and zero on entries that are constrained. */
    using Operator = std::function<void(Vector &dst, const Vector &src)>;

    /**
     * @param apply       on the finest level
     * @param diagonal    of that level, in the layout of its vectors
     * @param constrained owned entries
     * @param aggregates  of the next level
     */
    Multigrid(const Operator                  &apply,
              const Vector                    &diagonal,
              const std::vector<unsigned int> &constrained,
              std::unique_ptr<Aggregates>      aggregates);

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

    FinestLevel                               finest;
    const std::unique_ptr<const Aggregates>   aggregates;
    Smoother                                  smoother;
    dealii::TrilinosWrappers::PreconditionAMG coarser;
    mutable Vector residual, coarse_residual, coarse_change;
  };
} // namespace Voussoir

#endif
