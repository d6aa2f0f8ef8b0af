#ifndef voussoir_materials_damped_response_h
#define voussoir_materials_damped_response_h

#include <voussoir/fem/cell_kernel.h>
#include <voussoir/materials/crack_directions.h>
#include <voussoir/materials/law.h>

#include <limits>

namespace Voussoir
{
  /** Internal variables of a point of a law: its own, and filters of its
   *  plastic strain for each branch of Maxwell damping. */
  template <typename Law>
  inline constexpr unsigned int
    n_history_of = Law::n_history +
                   (Law::flows ? 6 * DampingParameters::most_branches : 0);


  /**
   * Response of a point of a law with internal variables under a damping
   * model. With
   * - u: displacement [m], B u its strain [1],
   * - w: damping memory [m]: filters of u, times the damping factor, and the
   *   mesh viscosity,
   * - D: elastic stiffness of the law [Pa],
   * - k: factor on the stress that makes the moduli hold at the reference
   *   frequency,
   * - e_0: strain offset [1] by static factor and temperature,
   * - e_s: elastic strain of the static state [1], on which damping does not
   *   act,
   * - e_p: plastic strain of the law [1], of which the branches of Maxwell
   *   damping feel nothing: w is filtered from B u - e_p where a law reports
   *   its flow,
   * - r: share of the stiffness that damage has left before this step [1],
   *
   * the strain passed to the law is the one whose elastic stress is the total
   * stress of an elastic point,
   *
   *   e = B u + e_0 + (k_r - 1) (B u - e_p - e_s) + r^4 k_r B w ,
   *   1/k_r = 1 - r + r/k ,
   *
   * so that the law fails at its strength at any strain rate. The stress is
   *
   *   sigma(e) - D : (e_0 - (k - 1) e_s) + s n n ,
   *
   * or k D : B (u + w) as long as the law is elastic and r = 1. The modulus k D
   * instead of D is that of a spring in series with the law, whose compliance
   * (1/k - 1) D^-1 does not change with damage: the spring returns its stored
   * energy as a crack relieves it, and the law dissipates exactly its own
   * energy. Damping must not transmit tension across a crack, hence the power
   * of r.
   *
   * The closing of a crack is an impact: oscillations between the two
   * stiffnesses of a unilateral crack gain energy, at any time step. Therefore
   * a viscosity c acts on the traction of the effective stress across the
   * crack, s = c d(n . D : B u . n)/dt , while by this traction the crack is
   * closed, about to close or just opened; it never acts in a crack that stays
   * open.
   *
   * Central differences integrate the stress by the trapezoidal rule, so that
   * in a step from a to b there are three kinds of work, each with its own sum:
   * - (sigma_a + sigma_b) : de/2 on the law. Of this work, with the stored
   *   energy sigma : e_e / 2 of the elastic strain e_e, the law dissipates
   *   exactly
   *     (sigma_a : e_e,b - sigma_b : e_e,a)/2 + (sigma_a + sigma_b) : de_p/2 .
   *   The balance uses the loss that the law itself reports instead, so that it
   *   reveals a law that reports too little or too much. Where no internal
   *   variable has changed the law is elastic and loses nothing: the remainder
   *   is then the error of the trapezoidal rule where cracks open and close,
   *   and is added to the loss of closing.
   * - (s_a + s_b) n . B du . n / 2 on the viscosity of closing, all of it lost.
   * - (sigma_a + sigma_b) : (B du - de)/2 on damping. Of this work, summed up
   *   since the static state, damping stores
   *     (1/k_r - 1) sigma : e_e / 2, from the static state sigma_s, e_e,s on
   *       (1/k_r - 1) [ sigma : e_e / 2 - sigma_s : (e_e - e_e,s / 2) ],
   *     + r^4 [ k (1 + 1/(s sum D_i)) w : D : w / 2 - sigma : w + j ] .
   *   Here j is the imbalance of the branches, the energy that they store above
   *   the least one for their sum w, k w : D : w / (2 s sum D_i). A point
   *   leaves the elastic range with the j of the last energy balance; from then
   *   on j relaxes like the slowest branch, or is that of the branches where
   *   the law reports its flow. As long as the law is elastic, this
   *   energy and that of the law are those of the springs of an elastic point:
   *   nothing jumps when a point leaves the elastic range.
   */
  template <typename Law>
  class DampedResponse
  {
  public:
    /** @param stress_factor k
     *  @param damping_factor s
     *  @param branches sum D_i of Maxwell damping [1]; 0 if there is none, or
     *   where only static states are computed */
    DampedResponse(const Law   &law,
                   const double stress_factor,
                   const double damping_factor = 1.,
                   const double branches       = 0.)
      : law(law)
      , k(stress_factor)
      , s(damping_factor)
      , memory_factor(k + (s * branches > 0. ? k / (s * branches) : 0.))
    {}

    /** Strain whose elastic stress is the constant difference between the
     *  stress of the law and the stress of the equation of motion. */
    SymmetricTensor3<Lanes>
    elastic_offset(const unsigned int  batch,
                   const unsigned int  q,
                   const PointHistory &history) const
    {
      return history.strain_offset(batch, q) -
             (k - 1.) * history.static_strain(batch, q);
    }

    /**
     * Advances the internal variables of point @p q of the cells of a batch by
     * one step, and sums up the losses.
     *
     * @param elastic    stress if the law is elastic
     * @param level yield ratio: the law is elastic where it is at most one
     * @param filtered   B (u + w)
     * @param own_strain B u
     * @param n_cells    of the batch; further lanes hold copies
     * @param weight     of the point in an integral [m3]
     * @return the stress [Pa]
     */
    SymmetricTensor3<Lanes>
    advance(const SymmetricTensor3<Lanes> &elastic,
            const Lanes                   &level,
            const SymmetricTensor3<Lanes> &filtered,
            const SymmetricTensor3<Lanes> &own_strain,
            const unsigned int             batch,
            const unsigned int             q,
            const unsigned int             n_cells,
            const Lanes                   &weight,
            const PointStep               &step,
            PointHistory                  &history) const
    {
      static const ActivePoint elastic_point;
      const bool               was_active = history.is_active(batch, q);
      const ActivePoint       &last =
        was_active ? history.active_point(batch, q) : elastic_point;
      ActivePoint now = last;

      SymmetricTensor3<Lanes> offset, elastic_static, of_law_alone;
      if (history.has_static_strains())
        {
          offset         = history.strain_offset(batch, q);
          elastic_static = history.static_strain(batch, q);
          of_law_alone   = elastic_offset(batch, q, history);
        }
      Lanes                  *values = history.values(batch, q);
      SymmetricTensor3<Lanes> filter = filtered - own_strain;
      if constexpr (Law::flows)
        if (step.maxwell != nullptr)
          filter -= decay_filters_of_flow(values, step);
      now.strain     = own_strain;
      now.law_strain = own_strain + offset +
                       (modulus(last.share) - 1.) *
                         (own_strain - last.plastic - elastic_static) +
                       modulus(last.share) * fourth_power(last.share) * filter;

      find_bands(history.bands(batch), now);
      PointSituation<Lanes> situation{now.band,
                                      step.length,
                                      history.tip_strength(batch)};
      if (history.has_planes())
        take_planes(history.planes_of(batch), last, now, situation);
      const auto response = law.respond(now.law_strain, values, situation);
      now.share           = response.damping_share;
      now.plastic         = now.law_strain - response.elastic_strain;
      now.stress          = response.stress;

      const Lanes begins =
        find_beginning(last, level, history.lanes_are_alone(), values, now);

      if constexpr (Law::flows)
        if (step.maxwell != nullptr)
          add_flow(response.plastic_increment, now, values, step);

      const SymmetricTensor3<Lanes> change = own_strain - last.strain;
      if (was_active)
        now.impact = impact(law.stress(change),
                            law.stress(response.elastic_strain),
                            last,
                            now,
                            step);

      now.filter           = filter;
      now.filter_imbalance = last.filter_imbalance * step.relaxation;

      const Lanes lost    = response.dissipation;
      Lanes       closing = 0., taken_by_damping = 0.;
      if (was_active)
        {
          closing = 0.5 * (last.impact + now.impact) *
                    (now.normal * (change * now.normal));
          const Lanes largest_energy =
            std::abs(now.stress * response.elastic_strain) +
            std::numeric_limits<double>::min();
          // less the loss that the law reports, however small
          const Lanes switched =
            0.5 * (last.stress * response.elastic_strain -
                   now.stress * (last.law_strain - last.plastic)) -
            lost;
          closing +=
            dealii::compare_and_apply_mask<dealii::SIMDComparison::less_than>(
              change_of_memory(last, now) + std::abs(lost) / largest_energy,
              Lanes(round_off),
              switched,
              Lanes(0.));
          taken_by_damping =
            0.5 * ((last.stress + now.stress) *
                   (change - (now.law_strain - last.law_strain)));
        }
      if (any_above(begins, 0.))
        {
          const Lanes imbalance = history.imbalance(batch, q);
          now.filter_imbalance =
            dealii::compare_and_apply_mask<dealii::SIMDComparison::equal>(
              begins, Lanes(1.), imbalance, now.filter_imbalance);
          const Lanes brought =
            work_while_elastic(now, elastic_static, offset, imbalance);
          taken_by_damping =
            dealii::compare_and_apply_mask<dealii::SIMDComparison::equal>(
              begins, Lanes(1.), brought, taken_by_damping);
        }
      for (unsigned int lane = 0; lane < n_cells; ++lane)
        if (now.band[lane] > 0.)
          {
            history.losses.material += weight[lane] * lost[lane];
            history.losses.damping += weight[lane] * taken_by_damping[lane];
            // the first step begins somewhere below the limit
            if (begins[lane] == 0.)
              history.losses.closing += weight[lane] * closing[lane];
          }

      SymmetricTensor3<Lanes> stress =
        now.total_stress() - law.stress(of_law_alone);
      if (history.lanes_are_alone())
        {
          for (unsigned int i = 0; i < 6; ++i)
            stress.access_raw_entry(i) =
              dealii::compare_and_apply_mask<dealii::SIMDComparison::equal>(
                now.band,
                Lanes(0.),
                elastic.access_raw_entry(i),
                stress.access_raw_entry(i));
          now.forget_elastic();
        }
      if (was_active)
        history.active_point(batch, q) = now;
      else if (any_above(begins, 0.))
        history.activate(batch, q, now);
      return stress;
    }

    /**
     * Converts a point from the law of the static state: it keeps its stress,
     * and `law_strain` becomes the strain at which this law has that stress.
     */
    void
    hand_over(const Law         &static_law,
              const double       static_factor,
              const unsigned int batch,
              const unsigned int q,
              PointHistory      &history) const
    {
      ActivePoint &point  = history.active_point(batch, q);
      Lanes       *values = history.values(batch, q);
      for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
        {
          const double band = point.band[lane];
          if (band == 0.)
            continue;
          SymmetricTensor3<double>           law_strain;
          std::array<double, Law::n_history> numbers, copy;
          for (unsigned int i = 0; i < 6; ++i)
            law_strain.access_raw_entry(i) =
              point.law_strain.access_raw_entry(i)[lane];
          for (unsigned int i = 0; i < Law::n_history; ++i)
            numbers[i] = copy[i] = values[i][lane];
          const auto response = static_law.respond(
            law_strain,
            copy.data(),
            PointSituation<double>{band, std::numeric_limits<double>::max()});
          law_strain = law.hand_over(
            law_strain, response, numbers.data(), band, static_factor);
          for (unsigned int i = 0; i < 6; ++i)
            point.law_strain.access_raw_entry(i)[lane] =
              law_strain.access_raw_entry(i);
          for (unsigned int i = 0; i < Law::n_history; ++i)
            values[i][lane] = numbers[i];
        }
    }

    /**
     * Sets e_0 and e_s of a point; for an elastic one, with the static factor
     * a,
     *   e_0 = (a - 1) B u_s - a alpha T I ,   e_s = B u_s - e_p .
     *
     * @param strain      B u_s
     * @param temperature T in all components [K]
     * @param expansion   alpha [1/K]
     */
    void
    set_static_state(const SymmetricTensor3<Lanes>     &strain,
                     const dealii::Tensor<1, 3, Lanes> &temperature,
                     const double                       static_factor,
                     const double                       expansion,
                     const unsigned int                 batch,
                     const unsigned int                 q,
                     PointHistory                      &history) const
    {
      auto &offset = history.strain_offset(batch, q);
      offset       = (static_factor - 1.) * strain;
      for (unsigned int d = 0; d < 3; ++d)
        offset[d][d] -= static_factor * expansion * temperature[d];
      auto &elastic = history.static_strain(batch, q);
      elastic       = strain;
      if (!history.is_active(batch, q))
        return;
      ActivePoint &point = history.active_point(batch, q);
      for (unsigned int i = 0; i < 6; ++i)
        {
          auto       &of_point   = offset.access_raw_entry(i);
          auto       &law_strain = point.law_strain.access_raw_entry(i);
          const Lanes own        = strain.access_raw_entry(i);
          using Comparison       = dealii::SIMDComparison;
          of_point = dealii::compare_and_apply_mask<Comparison::equal>(
            point.band, Lanes(0.), of_point, law_strain - own);
          law_strain = own + of_point;
        }
      std::array<Lanes, Law::n_history> copy;
      std::copy_n(history.values(batch, q), Law::n_history, copy.begin());
      point.strain = strain;
      const auto response =
        law.respond(point.law_strain,
                    copy.data(),
                    PointSituation<Lanes>{band_of(point, history, batch), 0.});
      point.stress           = response.stress;
      point.plastic          = point.law_strain - response.elastic_strain;
      point.share            = response.damping_share;
      point.impact           = 0.;
      point.filter           = SymmetricTensor3<Lanes>();
      point.filter_imbalance = 0.;
      if (history.lanes_are_alone())
        point.forget_elastic();
      elastic -= point.plastic;
    }

    /** Filter of the plastic strain for one branch of Maxwell damping, times
     * the damping factor [1]. */
    static SymmetricTensor3<Lanes>
    filter_of_flow(const Lanes *values, const unsigned int branch)
    {
      SymmetricTensor3<Lanes> filter;
      for (unsigned int i = 0; i < 6; ++i)
        filter.access_raw_entry(i) = values[Law::n_history + 6 * branch + i];
      return filter;
    }

    /** Energies of a point [J/m3]; see InelasticEnergy. */
    struct Energy
    {
      Lanes stored, of_damping;
    };

    /**
     * Energy since the static state of a point that has left the elastic range,
     * less the work of the forces of that state; zero in lanes that are
     * elastic.
     *
     * @param strain        B u
     * @param static_strain B u_s, or zero
     * @param at_start      internal variables of that state; null: elastic
     */
    Energy
    energy(const SymmetricTensor3<Lanes> &strain,
           const SymmetricTensor3<Lanes> &static_strain,
           const unsigned int             batch,
           const unsigned int             q,
           const PointHistory            &history,
           const PointHistory            *at_start) const
    {
      const ActivePoint      &point           = history.active_point(batch, q);
      SymmetricTensor3<Lanes> law_strain_then = static_strain;
      if (history.has_static_strains())
        law_strain_then += history.strain_offset(batch, q);
      SymmetricTensor3<Lanes> elastic_then = law_strain_then,
                              stress_then  = law.stress(law_strain_then);
      if (at_start != nullptr && at_start->is_active(batch, q))
        {
          const ActivePoint &then = at_start->active_point(batch, q);
          for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
            if (then.band[lane] > 0.)
              for (unsigned int i = 0; i < 6; ++i)
                {
                  stress_then.access_raw_entry(i)[lane] =
                    then.stress.access_raw_entry(i)[lane];
                  elastic_then.access_raw_entry(i)[lane] =
                    then.law_strain.access_raw_entry(i)[lane] -
                    then.plastic.access_raw_entry(i)[lane];
                }
        }
      const SymmetricTensor3<Lanes> elastic = point.law_strain - point.plastic;
      const Lanes                   of_law =
        0.5 * (point.stress * elastic) -
        stress_then * (0.5 * elastic_then + point.law_strain - law_strain_then);
      // without the work of the forces of the static state on plastic flow
      const Lanes of_elastic = 0.5 * (point.stress * elastic) -
                               stress_then * (elastic - 0.5 * elastic_then);
      const Lanes damping_energy =
        (1. / modulus(point.share) - 1.) * of_elastic +
        filter_energy(point.filter,
                      point.stress - stress_then,
                      Law::flows ? history.imbalance(batch, q) :
                                   point.filter_imbalance,
                      point.share);
      const Lanes stored =
        of_law + damping_energy +
        0.5 * ((point.total_stress() - stress_then) * (strain - point.strain));
      const Lanes of_damping =
        damping_energy + stress_then * (point.strain - point.law_strain -
                                        static_strain + law_strain_then);
      using dealii::compare_and_apply_mask;
      using Comparison = dealii::SIMDComparison;
      const Lanes zero = 0.;
      return {compare_and_apply_mask<Comparison::equal>(
                point.band, zero, zero, stored),
              compare_and_apply_mask<Comparison::equal>(
                point.band, zero, zero, of_damping)};
    }

  private:
    static Lanes
    fourth_power(const Lanes &x)
    {
      const Lanes square = x * x;
      return square * square;
    }

    /** k_r [1]. */
    Lanes
    modulus(const Lanes &share) const
    {
      return k / (k + share * (1. - k));
    }

    /** Stored energy of the filter w [J/m3], at a stress sigma since the static
     *  state. */
    Lanes
    filter_energy(const SymmetricTensor3<Lanes> &filter,
                  const SymmetricTensor3<Lanes> &stress,
                  const Lanes                   &imbalance,
                  const Lanes                   &share) const
    {
      return fourth_power(share) *
             (0.5 * memory_factor * (law.stress(filter) * filter) -
              stress * filter + imbalance);
    }

    /** 1 in cells whose law leaves the elastic range in this step, else 0;
     *  while a cell is elastic its internal variables stay zero and @p now has
     *  no band.
     */
    static Lanes
    find_beginning(const ActivePoint &last,
                   const Lanes       &level,
                   const bool         lanes_are_alone,
                   Lanes             *values,
                   ActivePoint       &now)
    {
      Lanes begins = 0.;
      for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
        if (last.band[lane] == 0.)
          {
            // alone, this cell would not have been evaluated
            if (lanes_are_alone && !(level[lane] > 1.))
              for (unsigned int i = 0; i < Law::n_history; ++i)
                values[i][lane] = 0.;
            bool is_elastic = true;
            for (unsigned int i = 0; i < Law::n_history; ++i)
              is_elastic = is_elastic && values[i][lane] == 0.;
            if (is_elastic)
              now.band[lane] = 0.;
            else
              begins[lane] = 1.;
          }
      return begins;
    }

    /** Work on damping since the static state of a point that has been elastic
     *  until now [J/m3]. */
    Lanes
    work_while_elastic(const ActivePoint             &now,
                       const SymmetricTensor3<Lanes> &elastic_static,
                       const SymmetricTensor3<Lanes> &offset,
                       const Lanes                   &imbalance) const
    {
      const SymmetricTensor3<Lanes> law_strain_then = elastic_static + offset;
      const SymmetricTensor3<Lanes> elastic_strain =
        k * (now.strain - now.plastic - elastic_static + now.filter);
      const SymmetricTensor3<Lanes> stress = law.stress(elastic_strain);
      return filter_energy(now.filter, stress, imbalance, Lanes(1.)) +
             0.5 * (1. / k - 1.) * (stress * elastic_strain) +
             law.stress(law_strain_then) *
               (now.strain - now.law_strain - elastic_static + law_strain_then);
    }

    /** Relative change of damage and plastic strain. */
    static Lanes
    change_of_memory(const ActivePoint &last, const ActivePoint &now)
    {
      const Lanes tiny = std::numeric_limits<double>::min();
      const auto  flow = now.plastic - last.plastic;
      const Lanes of_flow =
        (flow * flow) / (now.law_strain * now.law_strain + tiny);
      return std::abs(now.share - last.share) / (last.share + tiny) +
             std::sqrt(of_flow);
    }

    /** Widths of bands; of elastic points, the width for any normal. */
    static Lanes
    band_of(const ActivePoint  &point,
            const PointHistory &history,
            const unsigned int  batch)
    {
      return dealii::compare_and_apply_mask<dealii::SIMDComparison::equal>(
        point.band, Lanes(0.), history.bands(batch).widest, point.band);
    }

    /** Sets a missing band to that of the crack that would open now. */
    void
    find_bands(const CrackBands &bands, ActivePoint &point) const
    {
      const Lanes known = point.band;
      using dealii::compare_and_apply_mask;
      using Comparison = dealii::SIMDComparison;
      bool all_known   = true;
      for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
        all_known = all_known && known[lane] > 0.;
      if (all_known)
        return;
      const auto  crack = crack_directions(law.stress(point.law_strain));
      const Lanes zero  = 0.;
      for (unsigned int d = 0; d < 3; ++d)
        point.normal[d] = compare_and_apply_mask<Comparison::equal>(
          known, zero, crack.normal[d], point.normal[d]);
      const Lanes share = crack.share_of_tension;
      const Lanes band  = share * bands.across(crack.tension) +
                         (1. - share) * bands.across(crack.compression);
      point.band =
        compare_and_apply_mask<Comparison::equal>(known, zero, band, known);
    }

    /** Points that are elastic take normal and band from the plane of their
     *  cell. Others have theirs, crushed ones, too, whose stress a crack across
     *  no principal direction would change at once. */
    static void
    take_planes(const PlanesOfBatch   &planes,
                const ActivePoint     &last,
                ActivePoint           &now,
                PointSituation<Lanes> &situation)
    {
      for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
        if (last.band[lane] == 0. && planes.width[lane] > 0.)
          {
            now.band[lane] = planes.width[lane];
            dealii::Tensor<1, 3> normal;
            for (unsigned int d = 0; d < 3; ++d)
              normal[d] = planes.opening[d][lane];
            if (normal.norm() > 0.) // a first crack has that of the law
              for (unsigned int d = 0; d < 3; ++d)
                now.normal[d][lane] = situation.crack_normal[d][lane] =
                  normal[d];
          }
      situation.element_length = now.band;
    }

    /** s of a closing crack [Pa], from effective stresses. */
    static Lanes
    impact(const SymmetricTensor3<Lanes> &change,
           const SymmetricTensor3<Lanes> &stress,
           const ActivePoint             &last,
           const ActivePoint             &now,
           const PointStep               &step)
    {
      using dealii::compare_and_apply_mask;
      using Comparison     = dealii::SIMDComparison;
      const Lanes zero     = 0.;
      const Lanes changed  = now.normal * (change * now.normal),
                  traction = now.normal * (stress * now.normal);
      const Lanes viscous  = step.closing_viscosity / step.length * changed;
      const Lanes closed   = compare_and_apply_mask<Comparison::less_than>(
        traction - std::abs(changed), zero, viscous, zero);
      return compare_and_apply_mask<Comparison::less_than>(
        now.share,
        Lanes(1.),
        compare_and_apply_mask<Comparison::equal>(
          last.band, zero, zero, closed),
        zero);
    }

    /** Decays the filters of the plastic strain, one of each branch after the
     *  internal variables of the law, and returns their sum. */
    static SymmetricTensor3<Lanes>
    decay_filters_of_flow(Lanes *values, const PointStep &step)
    {
      SymmetricTensor3<Lanes> sum;
      Lanes                  *filter = values + Law::n_history;
      for (const double decay : step.maxwell->decay)
        for (unsigned int i = 0; i < 6; ++i, ++filter)
          {
            *filter *= decay;
            sum.access_raw_entry(i) += *filter;
          }
      return sum;
    }

    /** Adds the plastic strain of a step to these filters, where a point has
     *  left the elastic range; they act from the next step on. */
    void
    add_flow(const SymmetricTensor3<Lanes> &increment,
             const ActivePoint             &now,
             Lanes                         *values,
             const PointStep               &step) const
    {
      Lanes *filter = values + Law::n_history;
      for (const double gain : step.maxwell->gain)
        for (unsigned int i = 0; i < 6; ++i, ++filter)
          *filter +=
            dealii::compare_and_apply_mask<dealii::SIMDComparison::equal>(
              now.band,
              Lanes(0.),
              Lanes(0.),
              s * gain / step.length * increment.access_raw_entry(i));
    }

    static constexpr double round_off = 1e-9;

    const Law   &law;
    const double k, s, memory_factor;
  };
} // namespace Voussoir

#endif
