#include <voussoir/analysis/multigrid.h>

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
                       const Vector                    &diagonal,
                       const std::vector<unsigned int> &constrained,
                       std::unique_ptr<Aggregates>      made)
    : finest(apply, diagonal.size())
    , aggregates(std::move(made))
    , residual(diagonal)
    , coarse_residual(aggregates->create_vector())
    , coarse_change(coarse_residual)
  {
    Teuchos::ParameterList list;
    ML_Epetra::SetDefaults("SA", list);
    list.set("ML output", 0);
    list.set("PDE equations", int(aggregates->n_modes));
    list.set("aggregation: type", "Uncoupled");
    list.set("aggregation: threshold", 0.01);
    list.set("smoother: type", "Chebyshev");
    list.set("smoother: sweeps", 3);
    list.set("coarse: type", "Amesos-KLU");
    list.set("null space: type", "pre-computed");
    list.set("null space: dimension", int(aggregates->n_modes));
    list.set("null space: vectors",
             const_cast<double *>(aggregates->near_kernel().data()));
    // eigenvalues are estimated from random vectors: the same ones every time
    ML_set_random_seed(1);
    coarser.initialize(aggregates->matrix(), list);

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
    smoother.vmult(dst, src);
    finest.vmult(residual, dst);
    residual.sadd(-1., 1., src);
    aggregates->restrict_to(coarse_residual, residual);
    coarser.vmult(coarse_change, coarse_residual);
    aggregates->add_prolongated(dst, coarse_change);
    smoother.step(dst, src);
  }
} // namespace Voussoir
