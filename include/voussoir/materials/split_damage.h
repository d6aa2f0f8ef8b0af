#ifndef voussoir_materials_split_damage_h
#define voussoir_materials_split_damage_h

#include <voussoir/base/option.h>
#include <voussoir/fem/crack_growth.h>
#include <voussoir/materials/softening_curve.h>
#include <voussoir/materials/tension_split.h>

namespace Voussoir
{
  /** Direction of a crack while the principal strains rotate. */
  enum class CrackDirection
  {
    rotating,
    fixed
  };

  inline OptionNames<CrackDirection>
  option_names(const CrackDirection)
  {
    return {{CrackDirection::rotating, "rotating"},
            {CrackDirection::fixed, "fixed"}};
  }


  /**
   * Common part of laws with two scalar damages of the effective stress s = C :
   * e_e , which is split into tension and compression (see split_tension):
   *   sigma = (1 - d+) s+ + (1 - d-) s- .
   * Each damage follows a uniaxial curve by its own equivalent stress, so that
   * a step needs no iteration, and a closing crack regains its stiffness.
   *
   * Cracks rotate with the principal strains, or keep the plane in which they
   * began: in the latter case the compressed part is that of
   * stress_beside_crack.
   *
   * A crack that begins at the tip of another one has a factor f on its
   * strength and 1/f on its openings: at the strain e in a band of width l it
   * has f times the stress that the curve itself has at e/f in a band f^2 l. In
   * the static state f is that of the tip at once, also where the stress is
   * higher: a crack that began at this stress would be in unstable equilibrium.
   *
   * The history begins with the internal variables of the two curves, the
   * normal of the crack, and its f if cracks grow from tips.
   */
  struct SplitDamage : IsotropicElasticity, TensileCrack
  {
    SofteningCurve tension, compression;
    CrackDirection crack_direction = CrackDirection::rotating;
    double         crack_friction  = 0.4;
    CrackGrowth    crack_growth    = CrackGrowth::local;
    bool           is_at_rest      = false; // law of the static state

    /** @param sign 0: tension, 1: compression */
    const SofteningCurve &
    curve(const unsigned int sign) const
    {
      return sign == 0 ? tension : compression;
    }

    void
    declare_parameters(dealii::ParameterHandler &prm)
    {
      IsotropicElasticity::declare_parameters(prm);
      TensileCrack::declare_parameters(prm);
      add_option(
        prm,
        "Crack direction",
        crack_direction,
        "Whether cracks rotate with the principal strains, or are fixed in the "
        "plane in which they began. A fixed crack that runs at an angle to the "
        "rows of cells does not lock; its shear and opening follow from "
        "\"Crack friction\".");
      prm.add_parameter("Crack friction",
                        crack_friction,
                        "Friction of a fixed crack: ratio of shear to pressure "
                        "where its rough faces slide on each other, and of "
                        "opening to slip.",
                        dealii::Patterns::Double(0.2, 2.));
      add_option(
        prm,
        "Crack growth",
        crack_growth,
        "Whether a cell cracks by the tensile strength alone, or also by the "
        "lower strength ft / sqrt(1 + h ft^2 / (E Gf)) of a cell of size h "
        "that the plane of a crack runs into, with which cracks run at about "
        "the load of fracture mechanics in cells of any size; cells at slits, "
        "re-entrant corners and other notches are weaker, too. \"Along "
        "planes\", for cells with one integration point, continues each crack "
        "as a plane from cell to cell, in the direction of the stress there, so "
        "that its path does not follow the rows of cells; cells beside a crack "
        "have twice the strength.");
    }

    TensileFailure
    tensile_failure() const
    {
      return tension.failure();
    }

    /** Along planes, with 1.5 times the size of the cell: fitted to the load
     *  at which a crack runs through a plate (doc/damage.md). */
    double
    tip_strength(const double cell_size) const
    {
      switch (crack_growth)
        {
          case CrackGrowth::from_tips:
            return tension.tip_strength(cell_size);
          case CrackGrowth::along_planes:
            return tension.tip_strength(1.5 * cell_size);
          default:
            return 1.;
        }
    }

    bool
    cracks_along_planes() const
    {
      return crack_growth == CrackGrowth::along_planes;
    }

    static bool
    is_cracked(const double *history)
    {
      return history[0] > 0.;
    }

    void
    set_static(const double factor, const double strength_increase = 1.)
    {
      IsotropicElasticity::set_static(factor);
      is_at_rest = true;
      tension    = tension.of_static_state(young_modulus, strength_increase);
      compression =
        compression.of_static_state(young_modulus, strength_increase);
    }

    /** Stress and inelastic strain e - C^-1 : sigma are kept, and so are the
     *  openings of cracks and their factor f. */
    SymmetricTensor3<double>
    hand_over(const SymmetricTensor3<double> &strain,
              const PointResponse<double>    &response,
              double                         *history,
              const double                    element_length,
              const double                    static_factor) const
    {
      for (const unsigned int sign : {0, 1})
        {
          double *numbers = history + n_of_curve * sign;
          if (numbers[0] == 0.)
            continue;
          const DamageHandedOver now(damage_of(history, sign), static_factor);
          const double factor = sign == 0 ? factor_of_crack(history) : 1.;
          CurveMemory  memory{};
          curve(sign).hand_over(now.damage,
                                numbers[2] * now.strain_factor,
                                factor * factor * element_length,
                                memory);
          numbers[0] = memory.largest;
          numbers[1] = memory.position;
          numbers[2] = memory.last;
          numbers[3] = memory.damage;
        }
      return strain_handed_over(strain, response.stress, static_factor);
    }

    std::string
    remark(const double element_length) const
    {
      const std::string in_tension = tension.remark(element_length),
                        in_compression =
                          compression.remark(element_length,
                                             "crushing",
                                             "compressive strength");
      return in_tension +
             (in_tension.empty() || in_compression.empty() ? "" : ", and ") +
             in_compression;
    }

    /** Internal variables of one curve and of both. */
    static constexpr unsigned int n_of_curve      = CurveMemory::n_numbers,
                                  normal_at       = 2 * n_of_curve,
                                  strength_at     = normal_at + 3,
                                  n_split_numbers = strength_at + 1;

    static double
    damage_of(const double *history, const unsigned int sign)
    {
      return history[n_of_curve * sign + 3];
    }

    /** The factor f of a crack. */
    static double
    factor_of_crack(const double *history)
    {
      const double kept = history[strength_at];
      return kept > 0. ? kept : 1.;
    }

    /**
     * Advances one damage. The curve is evaluated only where the damage may
     * grow.
     *
     * @param equivalent effective stress of a uniaxial test [Pa]
     * @param memory internal variables as of CurveMemory
     * @param followed,held see SofteningCurve::go_on
     * @param flows      whether a share of the strain is irreversible
     */
    template <typename Number>
    DamageProgress<Number>
    grow(const unsigned int            sign,
         const Number                 &equivalent,
         Number                       *memory,
         const PointSituation<Number> &situation,
         const double                  followed = 1.,
         const bool                    flows    = false,
         const Number                 &held     = Number(1.)) const
    {
      Number &largest = memory[0], &position = memory[1], &last = memory[2],
             &damage = memory[3];
      DamageProgress<Number> progress;
      progress.intact   = 1. - damage;
      const Number zero = 0.;
      const Number growth =
        std::min(Number(equivalent - young_modulus * largest),
                 Number(curve(sign).yield_ratio(equivalent,
                                                situation.element_length) -
                        1.));
      Number now =
        dealii::compare_and_apply_mask<dealii::SIMDComparison::equal>(
          largest,
          zero,
          zero,
          std::max(Number(equivalent / young_modulus), zero));
      if (any_above(flows ? std::max(growth, largest) : growth, 0.))
        for (unsigned int lane = 0; lane < n_lanes<Number>(); ++lane)
          if (lane_of(growth, lane) > 0. ||
              (flows && lane_of(largest, lane) > 0.))
            {
              CurveMemory one{lane_of(largest, lane),
                              lane_of(position, lane),
                              lane_of(last, lane),
                              lane_of(damage, lane)};
              progress.set_lane(
                lane,
                curve(sign).go_on(lane_of(equivalent, lane),
                                  one,
                                  lane_of(situation.element_length, lane),
                                  followed,
                                  lane_of(held, lane)));
              lane_of(largest, lane)  = one.largest;
              lane_of(position, lane) = one.position;
              lane_of(now, lane)      = one.last;
              lane_of(damage, lane)   = one.damage;
            }
      last = now;
      return progress;
    }

    /**
     * Cracks along planes that begin late, of an elastic point: beside a crack,
     * and where the plane of a wide band enters a cell whose stress is above
     * the elastic limit of this band.
     *
     * @param strength of the cell over that of the material
     * @param driving  equivalent stress over the factor at a tip [Pa]; 0: not
     * yet
     * @param held     see SofteningCurve::go_on
     */
    void
    hold(const double strength,
         const double band,
         double      &driving,
         double      &held) const
    {
      // that a step changes the stress by less
      constexpr double most_of_step = 1.05;
      const double     limit = young_modulus * tension.elastic_limit(band);
      if (driving < strength * limit)
        driving = 0.;
      else if (driving > most_of_step * limit)
        held = driving / limit;
    }

    /** Advances the damage in tension, whose strength at the tip of a crack is
     *  lower and beside a crack with a plane higher; see `grow`. */
    template <typename Number>
    DamageProgress<Number>
    grow_crack(const Number          &equivalent,
               Number                *history,
               PointSituation<Number> situation,
               const double           followed = 1.,
               const bool             flows    = false) const
    {
      if (crack_growth == CrackGrowth::local)
        return grow(0, equivalent, history, situation, followed, flows);
      using dealii::compare_and_apply_mask;
      using Comparison  = dealii::SIMDComparison;
      const Number zero = 0., one = 1.;
      const Number now =
        strength_where_tip_arrives(situation.tip_strength,
                                   is_at_rest ?
                                     zero :
                                     tension.yield_ratio(equivalent, zero));
      Number      &kept = history[strength_at];
      const Number factor =
        compare_and_apply_mask<Comparison::equal>(kept, zero, now, kept);
      situation.element_length = situation.element_length * factor * factor;
      Number driving = equivalent / factor, held = one;
      if (cracks_along_planes())
        for (unsigned int lane = 0; lane < n_lanes<Number>(); ++lane)
          if (lane_of(history[0], lane) == 0. && lane_of(driving, lane) > 0.)
            hold(lane_of(situation.tip_strength, lane),
                 lane_of(situation.element_length, lane),
                 lane_of(driving, lane),
                 lane_of(held, lane));
      const auto progress =
        grow(0, driving, history, situation, followed, flows, held);
      kept = compare_and_apply_mask<Comparison::equal>(history[0],
                                                       zero,
                                                       zero,
                                                       factor);
      return progress;
    }

    /** Largest opening of the crack so far [m]. */
    double
    largest_opening(const double *history, const double element_length) const
    {
      const double factor = factor_of_crack(history);
      return factor * element_length *
             tension.at(history[0], factor * factor * element_length).inelastic;
    }

    /** Result of a step in tension and in compression, or the parts of the
     *  stress. */
    template <typename T>
    using OfBoth = std::array<T, 2>;

    /**
     * The effective stresses s+ and s- after the damage in tension has
     * advanced.
     *
     * @param split of the elastic stress
     * @param crack_normal see PointSituation
     */
    template <typename Number>
    OfBoth<SymmetricTensor3<Number>>
    parts(const TensionSplit<Number>         &split,
          Number                             *history,
          const dealii::Tensor<1, 3, Number> &crack_normal) const
    {
      OfBoth<SymmetricTensor3<Number>> parts = split.parts();
      if ((crack_direction == CrackDirection::rotating &&
           !cracks_along_planes()) ||
          !any_above(history[0], 0.))
        return parts;
      using dealii::compare_and_apply_mask;
      using Comparison  = dealii::SIMDComparison;
      const Number zero = 0.;

      dealii::Tensor<1, 3, Number> normal;
      for (unsigned int d = 0; d < 3; ++d)
        normal[d] = history[normal_at + d];
      const Number is_new     = 1. - normal * normal,
                   is_unknown = 1. - crack_normal * crack_normal;
      for (unsigned int d = 0; d < 3; ++d)
        {
          normal[d] = compare_and_apply_mask<Comparison::less_than>(
            is_new, Number(0.5), normal[d], split.principal.directions[0][d]);
          if (cracks_along_planes())
            normal[d] = compare_and_apply_mask<Comparison::less_than>(
              is_unknown, Number(0.5), crack_normal[d], normal[d]);
          history[normal_at + d] =
            compare_and_apply_mask<Comparison::less_than_or_equal>(history[0],
                                                                   zero,
                                                                   zero,
                                                                   normal[d]);
        }

      const SymmetricTensor3<Number> stress = parts[0] + parts[1];
      const SymmetricTensor3<Number> beside =
        stress_beside_crack(stress, normal, *this, crack_friction);
      for (unsigned int i = 0; i < 6; ++i)
        {
          // to the last bit the parts of an intact point, whatever the points
          // beside it in a batch are
          Number &opened = parts[0].access_raw_entry(i),
                 &left   = parts[1].access_raw_entry(i);
          opened = compare_and_apply_mask<Comparison::less_than_or_equal>(
            history[0],
            zero,
            opened,
            Number(stress.access_raw_entry(i) - beside.access_raw_entry(i)));
          left = compare_and_apply_mask<Comparison::less_than_or_equal>(
            history[0], zero, left, beside.access_raw_entry(i));
        }
      return parts;
    }

    /** @param effective s+ and s- [Pa] */
    template <typename Number>
    static PointResponse<Number>
    response(const OfBoth<SymmetricTensor3<Number>> &effective,
             const OfBoth<DamageProgress<Number>>   &damage,
             const SymmetricTensor3<Number>         &elastic_strain)
    {
      PointResponse<Number> result(elastic_strain);
      result.stress =
        damage[0].intact * effective[0] + damage[1].intact * effective[1];
      result.damping_share = damage[0].intact * damage[1].intact;
      result.dissipation =
        0.5 * (damage[0].dissipation * (effective[0] * elastic_strain) +
               damage[1].dissipation * (effective[1] * elastic_strain));
      return result;
    }
  };
} // namespace Voussoir

#endif
