#include <voussoir/analysis/multigrid.h>

#include <Epetra_Operator.h>
#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // products with the operator before and after each correction, and the part
    // of the spectrum that they damp; degrees from 3 to 6 take the same time in
    // total
    constexpr unsigned int smoother_degree = 4;
    constexpr double       smoothing_range = 30.;
  } // namespace


  Multigrid::Multigrid(const Operator                  &apply,
                       TrilinosWrappers::SparseMatrix  &matrix,
                       const Vector                    &diagonal,
                       const std::vector<unsigned int> &constrained,
                       const unsigned int               n_components,
                       const Epetra_MultiVector        &near_kernel)
    : finest(apply, diagonal.size())
    , constrained(constrained)
    , residual(diagonal)
    , change(diagonal)
  {
    Teuchos::ParameterList list;
    ML_Epetra::SetDefaults("SA", list);
    list.set("ML output", 0);
    list.set("PDE equations", int(n_components));
    list.set("aggregation: type", "Uncoupled");
    list.set("aggregation: threshold", 0.02);
    // A smoothed finest prolongation would take half of all memory with its
    // products, and save a tenth of the iterations, but make each dearer.
    list.sublist("aggregation: list (level 0)")
      .set("aggregation: smoothing sweeps", 0);
    list.set("smoother: type", "Chebyshev");
    list.set("smoother: sweeps", 3);
    list.set("coarse: type", "Amesos-KLU");
    list.set("null space: type", "pre-computed");
    list.set("null space: dimension", near_kernel.NumVectors());
    list.set("null space: vectors", near_kernel.Values());
    // eigenvalues are estimated from random vectors: the same ones every time
    ML_set_random_seed(1);
    coarser.initialize(matrix, list);

    // the hierarchy is only read, but ML's interface has no const
    levels = const_cast<ML_Struct *>(
      dynamic_cast<const ML_Epetra::MultiLevelPreconditioner &>(
        coarser.trilinos_operator())
        .GetML());
    single_level = levels->ML_num_actual_levels < 2;
    if (single_level)
      return;

    const ML_Operator &restriction = levels->Rmat[levels->ML_finest_level];
    coarse_residual.resize(restriction.outvec_leng);
    coarse_change.resize(restriction.outvec_leng);
    matrix.clear();

    Smoother::AdditionalData data;
    data.degree              = smoother_degree;
    data.smoothing_range     = smoothing_range;
    data.eig_cg_n_iterations = 12;
    Vector inverse_diagonal  = diagonal;
    for (unsigned int i = 0; i < diagonal.locally_owned_size(); ++i)
      inverse_diagonal.local_element(i) = 1. / diagonal.local_element(i);
    for (const unsigned int i : constrained)
      inverse_diagonal.local_element(i) = 0.;
    data.preconditioner =
      std::make_shared<DiagonalMatrix<Vector>>(inverse_diagonal);
    smoother.initialize(finest, data);
  }


  void
  Multigrid::vmult(Vector &dst, const Vector &src) const
  {
    if (single_level)
      {
        coarser.vmult(dst, src);
        return;
      }
    smoother.vmult(dst, src);
    finest.vmult(residual, dst);
    residual.sadd(-1., 1., src);
    correct(dst, residual);
    smoother.step(dst, src);
  }


  void
  Multigrid::correct(Vector &dst, const Vector &right_side) const
  {
    ML_Operator &restriction  = levels->Rmat[levels->ML_finest_level];
    ML_Operator &prolongation = *restriction.to->Pmat;
    const int    n            = right_side.locally_owned_size(),
              n_coarse        = coarse_change.size();
    ML_Operator_Apply(&restriction,
                      n,
                      const_cast<double *>(right_side.begin()),
                      n_coarse,
                      coarse_residual.data());
    std::fill(coarse_change.begin(), coarse_change.end(), 0.);
    ML_Cycle_MG(restriction.to,
                coarse_change.data(),
                coarse_residual.data(),
                ML_ZERO,
                levels->comm,
                ML_NO_RES_NORM,
                levels);
    ML_Operator_Apply(
      &prolongation, n_coarse, coarse_change.data(), n, change.begin());
    for (const unsigned int i : constrained)
      change.local_element(i) = 0.;
    dst += change;
  }
} // namespace Voussoir
