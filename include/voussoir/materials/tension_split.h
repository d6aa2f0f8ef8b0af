#ifndef voussoir_materials_tension_split_h
#define voussoir_materials_tension_split_h

#include <voussoir/materials/isotropic_elasticity.h>
#include <voussoir/materials/spectral.h>

namespace Voussoir
{
  /** Names of results that several laws share. */
  namespace OutputName
  {
    inline const std::string tension_damage     = "tension damage",
                             compression_damage = "compression damage",
                             largest_opening    = "largest crack opening [mm]";
  }


  /**
   * Across an open crack the stress no longer contracts the material sideways:
   * a uniaxial test with the effective stress s has the strain
   * ((1 - k) s + k sigma)/E. This is k.
   */
  inline double
  lateral_relief(const IsotropicElasticity &elasticity)
  {
    const double nu = elasticity.poisson_ratio;
    return 2. * nu * nu / (1. - nu);
  }


  /** Principal values of an elastic stress, largest first, their directions,
   *  and their parts in tension and compression. */
  template <typename Number>
  struct TensionSplit
  {
    Spectrum<Number>      principal;
    std::array<Number, 3> tension, compression;

    /** The stresses of the two parts. */
    std::array<SymmetricTensor3<Number>, 2>
    parts() const
    {
      return {{principal.compose(tension), principal.compose(compression)}};
    }
  };

  /**
   * Splits the stress C : e into the stress n <= 0 of a material without
   * tensile strength and the rest C : a, of which an open crack relieves the
   * material: a >= 0 is the strain of the cracks, n : a = 0 (Del Piero 1989).
   * The two parts are orthogonal in the energy, so that damage of either has a
   * potential and no closed path of strains gains energy. A split by the signs
   * of principal stresses alone has none unless Poisson's ratio is zero.
   *
   * @param stress principal values and directions, in any order
   */
  template <typename Number>
  TensionSplit<Number>
  split_tension(const Spectrum<Number>    &stress,
                const IsotropicElasticity &elasticity)
  {
    using dealii::compare_and_apply_mask;
    using Comparison = dealii::SIMDComparison;
    TensionSplit<Number> split;
    split.principal  = stress;
    auto      &s     = split.principal.values;
    const auto order = [&](const unsigned int i, const unsigned int j) {
      const Number first = s[i], second = s[j];
      s[i]             = std::max(first, second);
      s[j]             = std::min(first, second);
      auto &directions = split.principal.directions;
      for (unsigned int d = 0; d < 3; ++d)
        {
          const Number a = directions[i][d], b = directions[j][d];
          directions[i][d] =
            compare_and_apply_mask<Comparison::less_than>(first, second, b, a);
          directions[j][d] =
            compare_and_apply_mask<Comparison::less_than>(first, second, a, b);
        }
    };
    order(0, 1);
    order(1, 2);
    order(0, 1);

    // no crack, a crack across the first direction, across two, three
    const double nu      = elasticity.poisson_ratio;
    const Number lateral = nu / (1. - nu) * s[0];
    const Number second = s[1] - lateral, third = s[2] - lateral,
                 alone = s[2] - nu * (s[0] + s[1]);
    const Number zero  = 0.;
    const auto   pick =
      [&](const Number &none, const Number &one, const Number &two) {
        return compare_and_apply_mask<Comparison::less_than_or_equal>(
          s[0],
          zero,
          none,
          compare_and_apply_mask<Comparison::less_than_or_equal>(
            second,
            zero,
            one,
            compare_and_apply_mask<Comparison::less_than_or_equal>(
              alone, zero, two, zero)));
      };
    split.compression = {{pick(s[0], zero, zero),
                          pick(s[1], second, zero),
                          pick(s[2], third, alone)}};
    for (unsigned int i = 0; i < 3; ++i)
      split.tension[i] = s[i] - split.compression[i];
    return split;
  }


  template <typename Number>
  TensionSplit<Number>
  split_tension(const SymmetricTensor3<Number> &stress,
                const IsotropicElasticity      &elasticity)
  {
    return split_tension(spectrum(stress), elasticity);
  }
} // namespace Voussoir

#endif
