// The sum-factorisation kernels at the vector width of the compiler flags.
// A file of its own because the headers of the evaluation kernels and of
// simd_matrix_free.cc share an include guard in deal.II 9.4.
#include <voussoir/fem/simd.h>

#if VOUSSOIR_SIMD_WIDENED

// the degrees and quadratures that Voussoir offers
#  define FE_EVAL_FACTORY_DEGREE_MAX 4

#  include <deal.II/matrix_free/evaluation_template_factory.templates.h>

DEAL_II_NAMESPACE_OPEN

template struct internal::FEEvaluationFactory<3, VectorizedArray<double>>;

DEAL_II_NAMESPACE_CLOSE

#endif
