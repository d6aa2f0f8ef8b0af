#ifndef voussoir_materials_crack_normal_h
#define voussoir_materials_crack_normal_h

#include <voussoir/materials/spectral.h>

namespace Voussoir
{
  /** Normal of the crack that would open under this stress: the direction of
   *  the largest tension or, where there is next to none, of the largest
   *  compression. */
  template <typename Number>
  dealii::Tensor<1, 3, Number>
  crack_normal(const SymmetricTensor3<Number> &stress)
  {
    using Comparison                       = dealii::SIMDComparison;
    const Spectrum<Number>       principal = spectrum(stress);
    dealii::Tensor<1, 3, Number> normal;
    Number                       severity = -1.;
    for (unsigned int i = 0; i < 3; ++i)
      {
        const Number &value = principal.values[i];
        const Number  own   = std::max(value, Number(-0.05 * value));
        for (unsigned int d = 0; d < 3; ++d)
          normal[d] = dealii::compare_and_apply_mask<Comparison::less_than>(
            severity, own, principal.directions[i][d], normal[d]);
        severity = std::max(severity, own);
      }
    return normal;
  }
} // namespace Voussoir

#endif
