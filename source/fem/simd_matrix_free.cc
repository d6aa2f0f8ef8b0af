// deal.II's matrix-free classes at the vector width of the compiler flags; the
// packaged library contains them for its own, narrower width only.
#include <voussoir/fem/simd.h>

#if VOUSSOIR_SIMD_WIDENED

// the degrees and quadratures that Voussoir offers
#  define FE_EVAL_FACTORY_DEGREE_MAX 4

#  include <deal.II/matrix_free/dof_info.templates.h>
#  include <deal.II/matrix_free/evaluation_template_face_factory.templates.h>
#  include <deal.II/matrix_free/evaluation_template_factory_hanging_nodes.templates.h>
#  include <deal.II/matrix_free/mapping_info.templates.h>
#  include <deal.II/matrix_free/matrix_free.templates.h>
#  include <deal.II/matrix_free/shape_info.templates.h>

DEAL_II_NAMESPACE_OPEN

template class MatrixFree<3, double, VectorizedArray<double>>;

template void
MatrixFree<3, double, VectorizedArray<double>>::internal_reinit<double, 3>(
  const std::shared_ptr<hp::MappingCollection<3>> &,
  const std::vector<const DoFHandler<3, 3> *> &,
  const std::vector<const AffineConstraints<double> *> &,
  const std::vector<IndexSet> &,
  const std::vector<hp::QCollection<3>> &,
  const AdditionalData &);

// used where the geometry of faces is prepared
template struct internal::FEFaceEvaluationFactory<3, VectorizedArray<double>>;

template struct internal::
  FEEvaluationHangingNodesFactory<3, double, VectorizedArray<double>>;

DEAL_II_NAMESPACE_CLOSE

#endif
