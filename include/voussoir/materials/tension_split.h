#ifndef voussoir_materials_tension_split_h
#define voussoir_materials_tension_split_h

#include <voussoir/materials/isotropic_elasticity.h>
#include <voussoir/materials/spectral.h>

#include <limits>

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
   * of principal stresses alone has no potential unless Poisson's ratio is
   * zero.
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

  /**
   * The stress n that remains of C : e with a rough crack in a plane, at any
   * angle to the principal strains, and with cracks across this plane:
   *   C : e = n + C : a ,   n : a = 0 ,   a = sym(n_c c) + b ,
   * with the jump c across the plane of normal n_c, c . n_c >= f |c_t|, and a
   * positive strain b in the plane. The jump may be oblique, as where rows of
   * cells are at an angle to their crack: the strain of such a crack has a
   * negative principal value, which split_tension takes for compression. A
   * closed crack carries shear up to f times its pressure, and dilates as it
   * slides: this keeps the parts orthogonal in the energy, so that they have a
   * potential and no closed path of strains gains energy.
   *
   * The plane is open, sliding or stuck; exactly one of these convex problems
   * has an admissible solution.
   *
   * @param normal   of length one
   * @param friction f > 0
   */
  template <typename Number>
  SymmetricTensor3<Number>
  stress_beside_crack(const SymmetricTensor3<Number>     &stress,
                      const dealii::Tensor<1, 3, Number> &normal,
                      const IsotropicElasticity          &elasticity,
                      const double                        friction)
  {
    using dealii::compare_and_apply_mask;
    using Comparison    = dealii::SIMDComparison;
    const double shear  = elasticity.shear_modulus(),
                 lambda = elasticity.bulk_modulus() - 2. / 3. * shear,
                 across = lambda + 2. * shear;
    const Number zero = 0., tiny = std::numeric_limits<double>::min();

    // traction, and the stress in the plane by its principal values
    const auto                         traction = stress * normal;
    const Number                       pull     = traction * normal;
    const dealii::Tensor<1, 3, Number> along    = traction - pull * normal;
    const Number                       sheared  = std::sqrt(along * along);
    const SymmetricTensor3<Number>     normals =
      symmetrize(outer_product(normal, normal));
    const SymmetricTensor3<Number> in_plane =
      stress - 2. * symmetrize(outer_product(normal, traction)) +
      pull * normals;
    const Number half_trace = 0.5 * (trace(stress) - pull);
    const Number radius     = std::sqrt(
      std::max(zero,
               Number(0.5 * (in_plane * in_plane) - half_trace * half_trace)));

    // the jump across the plane opens by by_pull pull + by_shear sheared
    struct Plane
    {
      Number by_plane, across_plane; // R' = by_plane R + across_plane (I - nn)
      Number pull, opening;
    };
    const auto solve = [&](const double by_pull, const double by_shear) {
      const double of_plane = lambda - lambda * lambda * by_pull,
                   one_way  = of_plane + 2. * shear;
      const Number shift    = lambda * (by_pull * pull + by_shear * sheared);
      const Number first    = half_trace + radius - shift,
                   second   = half_trace - radius - shift;
      const Number beside   = second - of_plane / one_way * first;
      const auto   pick =
        [&](const Number &none, const Number &one, const Number &two) {
          return compare_and_apply_mask<Comparison::less_than_or_equal>(
            first,
            zero,
            none,
            compare_and_apply_mask<Comparison::less_than_or_equal>(
              beside, zero, one, two));
        };
      Plane        plane;
      const Number share = -beside / (2. * radius + tiny);
      plane.by_plane     = pick(1., share, zero);
      plane.across_plane = pick(-shift, -share * (half_trace + radius), zero);
      plane.pull =
        pull - lambda * pick(zero,
                             first / one_way,
                             (first + second) / (2. * (of_plane + shear)));
      plane.opening = by_pull * plane.pull + by_shear * sheared;
      return plane;
    };
    const double sliding = friction * friction * across + shear;
    const Plane  open    = solve(1. / across, 0.),
                slides =
                  solve(friction * friction / sliding, friction / sliding),
                stuck = solve(0., 0.);

    const auto choose = [&](const Number &if_open,
                            const Number &if_it_slides,
                            const Number &if_stuck) {
      return compare_and_apply_mask<Comparison::less_than_or_equal>(
        Number(friction * across / shear * sheared),
        open.pull,
        if_open,
        compare_and_apply_mask<Comparison::less_than_or_equal>(
          Number(friction * stuck.pull + sheared),
          zero,
          if_stuck,
          if_it_slides));
    };
    const Number by_plane =
      choose(open.by_plane, slides.by_plane, stuck.by_plane);
    const Number across_plane =
      choose(open.across_plane, slides.across_plane, stuck.across_plane);
    const Number left_pull =
      choose(zero, slides.pull - across * slides.opening, stuck.pull);
    const Number left_shear =
      choose(zero,
             1. - shear / friction * slides.opening / (sheared + tiny),
             Number(1.));

    SymmetricTensor3<Number> left =
      by_plane * in_plane + (left_pull - across_plane) * normals +
      2. * left_shear * symmetrize(outer_product(normal, along));
    for (unsigned int d = 0; d < 3; ++d)
      left[d][d] += across_plane;
    return left;
  }
} // namespace Voussoir

#endif
