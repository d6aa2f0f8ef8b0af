#ifndef voussoir_materials_principal_stress_h
#define voussoir_materials_principal_stress_h

#include <voussoir/fem/simd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace Voussoir
{
  // GCC 12 finds "uninitialized" variables in its own AVX-512 intrinsics
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
  /**
   * Largest and smallest eigenvalue, without branches, so that it runs at the
   * full SIMD width.
   *
   * With cos(phi) = J3/2 (3/J2)^(3/2) and the mean m, the largest is m + 2
   * sqrt(J2/3) cos(phi/3); the smallest follows from the negative tensor. As a
   * function of cos(phi/2), cos(phi/3) is smooth all over [0, 1]; the
   * polynomial interpolates it at Chebyshev's points, to 2e-12.
   */
  template <typename Number>
  std::pair<Number, Number>
  largest_and_smallest_principal(const SymmetricTensor3<Number> &tensor)
  {
    const Number             mean = trace(tensor) / 3.;
    SymmetricTensor3<Number> s    = tensor; // deviator
    for (unsigned int d = 0; d < 3; ++d)
      s[d][d] -= mean;
    const Number radius = std::sqrt(Number(s * s / 6.)); // sqrt(J2/3)
    const Number cube =
      std::max(Number(2. * radius * radius * radius), Number(1e-300));
    const Number cosine =
      std::max(Number(-1.),
               std::min(Number(1.), Number(determinant(s) / cube)));

    const auto cosine_of_third = [](const Number &c) {
      static constexpr std::array<double, 13> coefficients{
        {0.76604444311897724,
         0.24740906630597206,
         -0.015509188431386371,
         0.0024663532862505386,
         -0.0005041248326161672,
         0.00011642171376423904,
         -2.8918815780743813e-05,
         7.5537080339070325e-06,
         -2.0396499767098949e-06,
         5.4367649555003371e-07,
         -1.5341954797175003e-07,
         6.1308054018109729e-08,
         -1.7969249746294317e-08}};
      const Number t     = 2. * std::sqrt(Number(0.5 * (1. + c))) - 1.;
      Number       value = coefficients.back();
      for (unsigned int i = coefficients.size() - 1; i-- > 0;)
        value = value * t + coefficients[i];
      return value;
    };
    return {mean + 2. * radius * cosine_of_third(cosine),
            mean - 2. * radius * cosine_of_third(-cosine)};
  }
#pragma GCC diagnostic pop
} // namespace Voussoir

#endif
