#ifndef voussoir_materials_damped_response_h
#define voussoir_materials_damped_response_h

#include <voussoir/fem/point_history.h>
#include <voussoir/fem/stiffness_factors.h>
#include <voussoir/materials/law.h>

namespace Voussoir
{
  /**
   * What a point of a law with memory does under a damping model. With
   *
   *   u    displacement [m], B u its strain [1]
   *   w    damping memory [m]: filters that follow u, times the damping factor
   *   D    elastic stiffness of the law [Pa]
   *   k    factor on the stress, StiffnessFactors::stress
   *   m    factor on the strain, StiffnessFactors::strain
   *   e_0  strain offset [1]: what the static factor and temperature do
   *   e_s  elastic strain of the static state [1], which damping leaves out
   *   e_p  plastic strain of the law [1]
   *   b    share that damage leaves of the stress of damping [1]
   *
   * the law sees e = m B u + e_0, without damping, and answers sigma(e).
   * Damping acts on the elastic strain since the static state by a stress of
   * its own:
   *
   *   sigma(e) - D : (e_0 - (k - m) e_s)
   *            + b D : [k B w + (k - m) (B u - e_p - e_s)] .
   *
   * As long as the law is elastic, that is k D : B (u + w). With b go the
   * energies that these stresses have stored; that of the filters is at least
   * k B w : D : B w / (2 sum D_i), with the sum of the springs' factors D_i,
   * StiffnessFactors::filters, and comes to this for a fast crack, which all
   * filters follow.
   */
  template <typename Law>
  class DampedResponse
  {
  public:
    DampedResponse(const Law &law, const StiffnessFactors &factors)
      : law(law)
      , k(factors.stress)
      , m(factors.strain)
      , filter_stiffness(factors.filters)
    {}

    /**
     * Lets the memory of point @p q of the cells of a batch go one step on, and
     * counts what is lost.
     *
     * @param filtered   B (u + w)
     * @param own_strain B u
     * @param n_cells    of the batch; further lanes hold copies
     * @param weight     of the point in an integral [m3]
     * @return the stress [Pa]
     */
    SymmetricTensor3<Lanes>
    advance(const SymmetricTensor3<Lanes> &filtered,
            const SymmetricTensor3<Lanes> &own_strain,
            const unsigned int             batch,
            const unsigned int             q,
            const unsigned int             n_cells,
            const Lanes                   &weight,
            const double                   time_step,
            PointHistory                  &history) const
    {
      SymmetricTensor3<Lanes> strain = m * own_strain, offset, elastic_static;
      if (history.has_static_strains())
        {
          offset         = history.strain_offset(batch, q);
          elastic_static = history.static_strain(batch, q);
          strain += offset;
        }
      Lanes     *values = history.values(batch, q);
      const auto response =
        law.respond(strain,
                    values,
                    PointSituation<Lanes>{history.element_length(batch),
                                          time_step});

      const double                  difference = k - m;
      const SymmetricTensor3<Lanes> stretch =
        own_strain - (strain - response.elastic_strain) - elastic_static;
      const SymmetricTensor3<Lanes> filter        = filtered - own_strain,
                                    filter_stress = k * law.stress(filter),
                                    stretch_stress =
                                      difference * law.stress(stretch);
      const Lanes before = history.damping_share(batch, q),
                  now    = response.damping_share;
      Lanes lost =
        response.dissipation +
        0.5 * (before + now) * (stretch_stress * response.plastic_increment) +
        0.5 * (before - now) * (stretch_stress * stretch);
      if (filter_stiffness > 0.)
        lost +=
          0.5 * (before - now) * (filter_stress * filter) / filter_stiffness;

      history.damping_share(batch, q) = now;
      for (unsigned int lane = 0; lane < n_cells; ++lane)
        history.dissipated += lost[lane] * weight[lane];
      if (!history.is_active(batch, q))
        for (unsigned int lane = 0; lane < n_cells; ++lane)
          for (unsigned int i = 0; i < Law::n_history; ++i)
            if (values[i][lane] != 0.)
              history.activate(batch, q);
      return response.stress -
             law.stress(offset - difference * elastic_static) +
             now * (filter_stress + stretch_stress);
    }

    /**
     * Sets e_0 and e_s of a point, with the static factor a,
     *   e_0 = (a - m) B u_s - a alpha T I ,   e_s = B u_s - e_p .
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
      offset       = (static_factor - m) * strain;
      for (unsigned int d = 0; d < 3; ++d)
        offset[d][d] -= static_factor * expansion * temperature[d];
      auto &elastic = history.static_strain(batch, q);
      elastic       = strain;
      if (history.is_active(batch, q))
        elastic -= m * strain + offset -
                   look_at(strain, batch, q, history, &history).elastic_strain;
    }

    /**
     * Energy stored at a point that has left the elastic range [J/m3]; with a
     * static state that since then, less what its forces do.
     *
     * @param strain        B u
     * @param static_strain B u_s; null without a static state
     * @param at_start      memory of that state; null: elastic
     */
    Lanes
    stored_energy(const SymmetricTensor3<Lanes> &strain,
                  const SymmetricTensor3<Lanes> *static_strain,
                  const unsigned int             batch,
                  const unsigned int             q,
                  const PointHistory            &history,
                  const PointHistory            *at_start) const
    {
      const auto now    = look_at(strain, batch, q, history, &history);
      Lanes      energy = 0.5 * (now.stress * now.elastic_strain);
      SymmetricTensor3<Lanes> stretched = now.elastic_strain;
      if (static_strain != nullptr)
        {
          const auto then =
            look_at(*static_strain, batch, q, history, at_start);
          const SymmetricTensor3<Lanes> moved = strain - *static_strain;
          energy -= then.stress * (0.5 * then.elastic_strain + moved);
          stretched -= then.elastic_strain;
        }
      // what the damping model takes off the moduli
      energy += 0.5 * (k - m) * history.damping_share(batch, q) *
                (law.stress(stretched) * stretched);
      return energy;
    }

  private:
    /** Response to a strain of the displacement with the @p remembered numbers
     *  (null: zeros), which stay as they are. */
    PointResponse<Lanes>
    look_at(const SymmetricTensor3<Lanes> &strain,
            const unsigned int             batch,
            const unsigned int             q,
            const PointHistory            &history,
            const PointHistory            *remembered) const
    {
      std::array<Lanes, Law::n_history> copy;
      copy.fill(Lanes(0.));
      if (remembered != nullptr)
        std::copy_n(remembered->values(batch, q), Law::n_history, copy.begin());
      SymmetricTensor3<Lanes> total = m * strain;
      if (history.has_static_strains())
        total += history.strain_offset(batch, q);
      return law.respond(total,
                         copy.data(),
                         PointSituation<Lanes>{history.element_length(batch),
                                               0.});
    }

    const Law   &law;
    const double k, m, filter_stiffness;
  };
} // namespace Voussoir

#endif
