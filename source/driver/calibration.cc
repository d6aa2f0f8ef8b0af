#include <voussoir/driver/calibration.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  CalibrationStep::CalibrationStep(const FullMatrix<double> &sensitivity,
                                   const Vector<double>     &misfit,
                                   const double              error)
  {
    // ratio of the smallest to the largest singular value below which the
    // errors of finite differences prevail
    constexpr double least_ratio = 1e-3;

    LAPACKFullMatrix<double> factors(sensitivity.m(), sensitivity.n());
    factors = sensitivity;
    factors.compute_svd();
    const unsigned int n = sensitivity.n();
    determined           = factors.singular_value(n - 1) >
                 least_ratio * std::max(1., factors.singular_value(0));
    if (!determined)
      return;

    FullMatrix<double> covariance(n, n);
    sensitivity.Tmmult(covariance, sensitivity);
    covariance.gauss_jordan();
    Vector<double> gradient(n);
    sensitivity.Tvmult(gradient, misfit);
    change.reinit(n);
    deviation.reinit(n);
    covariance.vmult(change, gradient);
    change *= -1.;
    for (unsigned int i = 0; i < n; ++i)
      deviation[i] = error * std::sqrt(covariance(i, i));
  }
} // namespace Voussoir
