#ifndef voussoir_materials_crack_directions_h
#define voussoir_materials_crack_directions_h

#include <voussoir/materials/spectral.h>

namespace Voussoir
{
  /** Direction in which a crack would open, or concrete be crushed, under a
   *  stress. */
  template <typename Number>
  struct CrackDirections
  {
    /** Direction of the largest tension or, where there is nearly none, of the
     *  largest compression. */
    dealii::Tensor<1, 3, Number> normal;

    dealii::Tensor<1, 3, Number> tension, compression;

    /** Share of `tension` against `compression` in the width of the band: zero
     *  or one unless both are about equally severe. The width must be
     *  continuous; otherwise the stress is not, and the search for equilibrium
     *  fails.
     */
    Number share_of_tension;
  };


  template <typename Number>
  CrackDirections<Number>
  crack_directions(const SymmetricTensor3<Number> &stress)
  {
    using Comparison                 = dealii::SIMDComparison;
    const Spectrum<Number> principal = spectrum(stress);
    const auto            &values    = principal.values;
    const auto             pick      = [&](const Number &sign) {
      dealii::Tensor<1, 3, Number> direction = principal.directions[0];
      Number                       most      = sign * values[0];
      for (unsigned int i = 1; i < 3; ++i)
        {
          const Number value = sign * values[i];
          for (unsigned int d = 0; d < 3; ++d)
            direction[d] =
              dealii::compare_and_apply_mask<Comparison::less_than>(
                most, value, principal.directions[i][d], direction[d]);
          most = std::max(most, value);
        }
      return std::make_pair(direction, std::max(most, Number(0.)));
    };
    const auto [tension, pull]      = pick(1.);
    const auto [compression, press] = pick(-1.);

    // compressive strength of concrete is about twenty times the tensile one
    const Number            severity = 0.05 * press;
    const Number            tiny     = 1e-300;
    CrackDirections<Number> result{tension, tension, compression, {}};
    for (unsigned int d = 0; d < 3; ++d)
      result.normal[d] = dealii::compare_and_apply_mask<Comparison::less_than>(
        pull, severity, compression[d], tension[d]);
    // from zero at half the severity to one at twice it
    result.share_of_tension =
      std::min(std::max(Number(3. * pull / (pull + severity + tiny) - 1.),
                        Number(0.)),
               Number(1.));
    return result;
  }
} // namespace Voussoir

#endif
