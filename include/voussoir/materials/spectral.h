#ifndef voussoir_materials_spectral_h
#define voussoir_materials_spectral_h

#include <voussoir/fem/point_history.h>

#include <array>
#include <cmath>

namespace Voussoir
{
  /** Principal values and directions of a symmetric tensor. */
  template <typename Number>
  struct Spectrum
  {
    std::array<Number, 3>                       values;
    std::array<dealii::Tensor<1, 3, Number>, 3> directions;

    /** The tensor of these directions with other values. */
    SymmetricTensor3<Number>
    compose(const std::array<Number, 3> &other_values) const
    {
      SymmetricTensor3<Number> result;
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j <= i; ++j)
            result[i][j] +=
              other_values[k] * directions[k][i] * directions[k][j];
      return result;
    }
  };


  /**
   * By Jacobi's rotations, in a fixed number of sweeps without branches, so
   * that it runs at the full SIMD width and does not mind equal values. The
   * order of the values is left open. Four sweeps reach round-off.
   */
  template <typename Number>
  Spectrum<Number>
  spectrum(const SymmetricTensor3<Number> &tensor)
  {
    Number a[3][3], v[3][3];
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        {
          a[i][j] = tensor[i][j];
          v[i][j] = i == j ? 1. : 0.;
        }
    const auto rotate =
      [&](const unsigned int p, const unsigned int q, const unsigned int r) {
        // tan of the rotation: t = sign(d) b / (|d| + sqrt(d^2 + b^2)) with
        // b = 2 a_pq and d = a_qq - a_pp; tiny keeps 0/0 away
        const Number tiny = 1e-290;
        const Number b = 2. * a[p][q], d = a[q][q] - a[p][p];
        const Number size = std::abs(d) + std::sqrt(Number(d * d + b * b));
        const Number sign =
          dealii::compare_and_apply_mask<dealii::SIMDComparison::less_than>(
            d, Number(0.), Number(-1.), Number(1.));
        const Number t = sign * b / (size + tiny);
        const Number c = 1. / std::sqrt(Number(1. + t * t)), s = t * c;
        a[p][p] -= t * a[p][q];
        a[q][q] += t * a[p][q];
        a[p][q] = a[q][p] = 0.;
        const Number rp = a[r][p], rq = a[r][q];
        a[r][p] = a[p][r] = c * rp - s * rq;
        a[r][q] = a[q][r] = s * rp + c * rq;
        for (unsigned int i = 0; i < 3; ++i)
          {
            const Number vp = v[i][p], vq = v[i][q];
            v[i][p] = c * vp - s * vq;
            v[i][q] = s * vp + c * vq;
          }
      };
    for (unsigned int sweep = 0; sweep < 4; ++sweep)
      {
        rotate(0, 1, 2);
        rotate(0, 2, 1);
        rotate(1, 2, 0);
      }
    Spectrum<Number> result;
    for (unsigned int k = 0; k < 3; ++k)
      {
        result.values[k] = a[k][k];
        for (unsigned int i = 0; i < 3; ++i)
          result.directions[k][i] = v[i][k];
      }
    return result;
  }


  /** Invariants that yield conditions are written in. */
  template <typename Number>
  struct Invariants
  {
    Number first;  // I1 = trace
    Number second; // J2 of the deviator
  };

  template <typename Number>
  Invariants<Number>
  invariants(const SymmetricTensor3<Number> &stress)
  {
    const Number             first    = trace(stress);
    SymmetricTensor3<Number> deviator = stress;
    for (unsigned int d = 0; d < 3; ++d)
      deviator[d][d] -= first / 3.;
    return {first, 0.5 * (deviator * deviator)};
  }
} // namespace Voussoir

#endif
