#ifndef voussoir_materials_spectral_h
#define voussoir_materials_spectral_h

#include <voussoir/fem/simd.h>

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
   * Finds the principal value furthest from the other two in closed form, and
   * the others in the plane across its direction (Scherzinger and Dohrmann
   * 2008). The result is exact to round-off, also for equal values; without
   * branches the function runs at the full SIMD width. The values are in no
   * particular order.
   */
  template <typename Number>
  Spectrum<Number>
  spectrum(const SymmetricTensor3<Number> &tensor)
  {
    using dealii::compare_and_apply_mask;
    constexpr auto less = dealii::SIMDComparison::less_than;
    const Number   zero = 0.;
    using Vector3       = dealii::Tensor<1, 3, Number>;

    // the deviator b over sqrt(J2/3) has the values 2 cos(phi + 2 pi k/3) with
    // cos(3 phi) = det(b)/2
    const Number             mean = (1. / 3.) * trace(tensor);
    SymmetricTensor3<Number> b    = tensor;
    for (unsigned int d = 0; d < 3; ++d)
      b[d][d] -= mean;
    // under equal pressure the deviator is round-off and not traceless
    const Number rest = (1. / 3.) * trace(b);
    for (unsigned int d = 0; d < 3; ++d)
      b[d][d] -= rest;
    const Number radius = std::sqrt(Number((1. / 6.) * (b * b)));
    b *= 1. / std::max(radius, Number(1e-150));
    const Number half   = 0.5 * determinant(b);
    const Number cosine = std::min(Number(std::abs(half)), Number(1.));

    // its cos(phi), the root of 4 x^3 - 3 x = cos(3 phi) from sqrt(3)/2 to 1,
    // by Newton's method from a cubic that is within 5e-5
    Number x =
      0.86607 + cosine * (0.16533 + cosine * (-0.04069 + cosine * 0.00932));
    for (unsigned int i = 0; i < 2; ++i)
      x = (8. * x * x * x + cosine) / (12. * x * x - 3.);
    const Number lone =
      compare_and_apply_mask<less>(half, zero, Number(-2. * x), Number(2. * x));

    // its direction is each column of the adjugate of b - lone I; the column
    // with the largest diagonal entry is the longest
    SymmetricTensor3<Number> c = b;
    for (unsigned int d = 0; d < 3; ++d)
      c[d][d] -= lone;
    Vector3 n;
    Number  largest = 0.;
    for (unsigned int i = 0; i < 3; ++i)
      {
        const unsigned int j = (i + 1) % 3, k = (i + 2) % 3;
        Vector3            column;
        column[i] = c[j][j] * c[k][k] - c[j][k] * c[j][k];
        column[j] = c[i][k] * c[j][k] - c[i][j] * c[k][k];
        column[k] = c[i][j] * c[j][k] - c[i][k] * c[j][j];
        for (unsigned int d = 0; d < 3; ++d)
          n[d] =
            compare_and_apply_mask<less>(largest, column[i], column[d], n[d]);
        largest = std::max(largest, column[i]);
      }
    n *= 1. / std::sqrt(n.norm_square());

    // two directions across it (Duff et al. 2017)
    const Number sign =
      compare_and_apply_mask<less>(n[2], zero, Number(-1.), Number(1.));
    const Number f = -1. / (sign + n[2]), g = n[0] * n[1] * f;
    Vector3      u, v;
    u[0] = 1. + sign * n[0] * n[0] * f;
    u[1] = sign * g;
    u[2] = -sign * n[0];
    v[0] = g;
    v[1] = sign + n[1] * n[1] * f;
    v[2] = -n[1];

    // one of Jacobi's rotations turns them into those of the other values:
    // t = sign(d) b / (|d| + sqrt(d^2 + b^2)) is its tangent with b = 2 b_uv
    // and d = b_vv - b_uu; tiny avoids 0/0
    const Vector3 bu = b * u, bv = b * v;
    const Number  uu = u * bu, uv = u * bv, vv = v * bv;
    const Number  tiny = 1e-150, twice = 2. * uv, d = vv - uu;
    const Number  size = std::abs(d) + std::sqrt(Number(d * d + twice * twice));
    const Number  tangent =
      compare_and_apply_mask<less>(d, zero, Number(-twice), twice) /
      (size + tiny);
    const Number cos = 1. / std::sqrt(Number(1. + tangent * tangent)),
                 sin = tangent * cos;
    return {{{mean + radius * lone,
              mean + radius * (uu - tangent * uv),
              mean + radius * (vv + tangent * uv)}},
            {{n, cos * u - sin * v, sin * u + cos * v}}};
  }


  /** Invariants that yield conditions are written in. */
  template <typename Number>
  struct Invariants
  {
    Number first;  // I1 = trace
    Number second; // J2 of the deviator
  };

  template <typename Number>
  DEAL_II_ALWAYS_INLINE inline Invariants<Number>
  invariants(const SymmetricTensor3<Number> &stress)
  {
    const Number             first    = trace(stress);
    SymmetricTensor3<Number> deviator = stress;
    for (unsigned int d = 0; d < 3; ++d)
      deviator[d][d] -= (1. / 3.) * first;
    return {first, 0.5 * (deviator * deviator)};
  }


  /** Bounds of the principal values, which lie within I1/3 -+ 2 sqrt(J2/3). */
  template <typename Number>
  struct PrincipalBounds
  {
    Number smallest, largest;
  };

  template <typename Number>
  DEAL_II_ALWAYS_INLINE inline PrincipalBounds<Number>
  principal_bounds(const SymmetricTensor3<Number> &stress)
  {
    const auto [first, second] = invariants(stress);
    const Number mean          = (1. / 3.) * first,
                 radius        = std::sqrt(Number((4. / 3.) * second));
    return {mean - radius, mean + radius};
  }

} // namespace Voussoir

#endif
