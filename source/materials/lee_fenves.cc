// Concrete of the plastic-damage model that most published analyses of dams
// use.

#include <voussoir/base/error.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/materials/isotropic_elasticity.h>
#include <voussoir/materials/lubliner_surface.h>
#include <voussoir/materials/material_of.h>
#include <voussoir/materials/tension_split.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Lee and Fenves (1998). Plastic strain e_p develops where the equivalent
     * compression of LublinerSurface under the effective stress s = C : (e -
     * e_p) reaches fc, with
     *   beta = (1 - alpha) fc / ft - (1 + alpha) ,  gamma = 0 ,
     * along the gradient of |dev s| + a_p I1. With the weight r of tension
     * among the principal stresses, the plastic strains
     *   d k_t = r d e_p,max ,   d k_c = -(1 - r) d e_p,min
     * give the strengths and the damages,
     *   sigma_t = ft0 exp(-b_t k_t) ,   D_t = 1 - exp(-q_t b_t k_t) ,
     *   sigma_c = fc0 [(1 + a) exp(-b_c k_c) - a exp(-2 b_c k_c)] ,
     *   D_c = 1 - exp(-q_c b_c k_c) ,   f = sigma / (1 - D) ,
     * where b_t and b_c make the plastic work over the cell's length that of
     * the fracture and the crushing energy. The stress is
     *   sigma = (1 - D_c) [(1 - D_t) s + w D_t s_c] ,
     * where s_c is the part of s of a material without tensile strength: the
     * share w of the stiffness comes back when a crack closes. Lee and Fenves
     * take (1 - D_c) (1 - D_t + w (1 - r) D_t) s, which has no potential: a
     * block that rocks and slides on its crack gains energy in every cycle.
     *
     * In the return mapping the deviator of s keeps its direction and its trace
     * falls in proportion, which leaves one equation. Beyond the apex the
     * return continues along the hydrostatic axis to zero stress, which is
     * always inside: the root is bracketed for every trial stress.
     */
    struct LeeFenves : IsotropicElasticity, LublinerSurface
    {
      // e_p, k_t, k_c
      static constexpr unsigned int n_history = 8;
      static constexpr bool         flows     = true;

      using Principal = std::array<double, 3>;

      double tensile_strength = 2.9e6;  // ft0 [Pa]
      double fracture_energy  = 200.;   // [N/m]
      double yield_strength   = 13e6;   // fc0 [Pa]
      double peak_strength    = 24.1e6; // [Pa]
      double crushing_energy  = 30e3;   // [N/m]
      double dilatancy        = 0.09;   // a_p
      double tension_ratio    = 1.2;    // q_t
      double crushing_ratio   = 1.;     // q_c
      double recovery         = 1.;     // w

      double hardening = 0.; // a

      void
      declare_parameters(ParameterHandler &prm)
      {
        IsotropicElasticity::declare_parameters(prm);
        prm.add_parameter("Tensile strength",
                          tensile_strength,
                          "Uniaxial tensile strength ft0 [Pa]." +
                            usually(Usual::tensile_strength),
                          Patterns::Double(1.));
        prm.add_parameter(
          "Fracture energy",
          fracture_energy,
          "Fracture energy: plastic work of a crack per area, the integral of "
          "the stress over the plastic opening [N/m]. The loss of stiffness "
          "takes further energy, in proportion to the size of the cells." +
            usually(Usual::fracture_energy),
          Patterns::Double(1e-3));
        prm.add_parameter("Yield strength in compression",
                          yield_strength,
                          "Uniaxial stress fc0 where crushing begins [Pa]." +
                            usually(Usual::compressive_strength),
                          Patterns::Double(1.));
        prm.add_parameter("Compressive strength",
                          peak_strength,
                          "Largest uniaxial stress [Pa]." +
                            usually(Usual::compressive_strength),
                          Patterns::Double(1.));
        prm.add_parameter("Crushing energy",
                          crushing_energy,
                          "Plastic work of crushing per area [N/m]." +
                            usually(Usual::crushing_energy),
                          Patterns::Double(1e-3));
        LublinerSurface::declare_parameters(prm);
        prm.add_parameter(
          "Dilatancy",
          dilatancy,
          "Coefficient a_p of the first invariant in the plastic potential. "
          "Lee and Fenves take 0.2; above 0.099 (with a biaxial ratio of 1.16) "
          "plastic flow under high confinement gains energy.",
          Patterns::Double(0., 0.4));
        prm.add_parameter(
          "Damage ratio in tension",
          tension_ratio,
          "Rate of the damage over that of the stress as a crack opens; with 1 "
          "the effective strength is constant and all softening is loss of "
          "stiffness. Below 1 large cells would snap back.",
          Patterns::Double(1., 1.9));
        prm.add_parameter("Damage ratio in compression",
                          crushing_ratio,
                          "Rate of the damage over that of the stress in "
                          "crushing.",
                          Patterns::Double(1., 1.9));
        prm.add_parameter(
          "Stiffness recovery",
          recovery,
          "Share w of the stiffness that comes back when a crack closes; Lee "
          "and Fenves take 1. With 0, parts on both sides of a crack through "
          "the body penetrate each other. With 1 a crack takes 4 % more "
          "energy, as it is relieved of lateral stress too.",
          Patterns::Double(0., 1.));
      }

      void
      check(const std::string &place)
      {
        if (peak_strength < yield_strength)
          throw UserError(place +
                          ": the \"Compressive strength\" is below the \"Yield "
                          "strength in compression\"; it must be as large or "
                          "larger.");
        LublinerSurface::check();
        // the largest sigma_c is fc0 (1 + a)^2 / (4 a)
        const double ratio = peak_strength / yield_strength;
        hardening = 2. * ratio - 1. + 2. * std::sqrt(ratio * (ratio - 1.));
      }

      TensileFailure
      tensile_failure() const
      {
        return {tensile_strength,
                young_modulus * fracture_energy /
                  (tensile_strength * tensile_strength)};
      }

      /** Strengths and stiffness left of the uniaxial curves. */
      struct Strengths
      {
        double tension, crushing;               // effective [Pa]
        double tension_intact, crushing_intact; // 1 - D
      };

      Strengths
      strengths(const double opening,
                const double crushing,
                const double length) const
      {
        // a wide crack has no tensile strength, but a finite effective strength
        const double t = std::max(1e-10,
                                  std::exp(-tensile_strength * length *
                                           opening / fracture_energy));
        const double c = std::exp(-yield_strength * (1. + 0.5 * hardening) *
                                  length * crushing / crushing_energy);
        Strengths    result;
        result.tension_intact  = std::pow(t, tension_ratio);
        result.crushing_intact = std::pow(c, crushing_ratio);
        result.tension  = tensile_strength * std::pow(t, 1. - tension_ratio);
        result.crushing = yield_strength * std::pow(c, 1. - crushing_ratio) *
                          (1. + hardening - hardening * c);
        return result;
      }

      /** Share of tension among principal stresses. */
      static double
      tension_weight(const Principal &s)
      {
        double positive = 0., all = 0.;
        for (const double value : s)
          {
            positive += std::max(value, 0.);
            all += std::abs(value);
          }
        return all > 0. ? positive / all : 0.;
      }

      /** Equivalent uniaxial compression of a stress, given strengths in
       *  tension and crushing. */
      template <typename Number>
      Number
      equivalent_compression(const Number &first,
                             const Number &second,
                             const Number &largest,
                             const double  tension,
                             const double  crushing) const
      {
        const double beta =
          std::max(0., (1. - alpha) * crushing / tension - (1. + alpha));
        return LublinerSurface::equivalent_compression(
          first,
          Number(std::sqrt(Number(3. * second))),
          Number(beta * std::max(largest, Number(0.))));
      }

      template <typename Number>
      Number
      yield_ratio(const SymmetricTensor3<Number> &stress, const Number &) const
      {
        const auto [first, second] = invariants(stress);
        return equivalent_compression(first,
                                      second,
                                      Number(first / 3. + 2. * std::sqrt(Number(
                                                                 second / 3.))),
                                      tensile_strength,
                                      yield_strength) /
               yield_strength;
      }

      /** Iterate of the return mapping. */
      struct Iterate
      {
        Principal stress;
        double    opening, crushing; // k_t, k_c
        double    excess;            // over the yield surface [Pa]
      };

      /**
       * @param progress 0 at the trial stress, 1 where its deviator is zero, 2
       * at zero stress
       */
      Iterate
      iterate_at(const Principal &trial,
                 const double     opening,
                 const double     crushing,
                 const double     length,
                 const double     progress) const
      {
        const double mean = (trial[0] + trial[1] + trial[2]) / 3.;
        double       norm = 0.;
        for (const double value : trial)
          norm += (value - mean) * (value - mean);
        const double axis = mean - 3. * bulk_modulus() * dilatancy *
                                     std::sqrt(norm) / (2. * shear_modulus());
        const double first_leg  = std::min(progress, 1.),
                     second_leg = std::max(progress - 1., 0.);
        const double new_mean =
          (mean + first_leg * (axis - mean)) * (1. - second_leg);

        Iterate      iterate;
        double       largest_strain = -1e300, least_strain = 1e300;
        const double dilation = (mean - new_mean) / (3. * bulk_modulus());
        for (unsigned int i = 0; i < 3; ++i)
          {
            const double deviator = trial[i] - mean;
            const double strain =
              first_leg * deviator / (2. * shear_modulus()) + dilation;
            largest_strain    = std::max(largest_strain, strain);
            least_strain      = std::min(least_strain, strain);
            iterate.stress[i] = new_mean + (1. - first_leg) * deviator;
          }
        const double weight = tension_weight(iterate.stress);
        iterate.opening     = opening + weight * std::max(largest_strain, 0.);
        iterate.crushing =
          crushing - (1. - weight) * std::min(least_strain, 0.);
        const Strengths now =
          strengths(iterate.opening, iterate.crushing, length);
        const double scale = 1. - first_leg;
        iterate.excess =
          equivalent_compression(3. * new_mean,
                                 0.5 * scale * scale * norm,
                                 *std::max_element(iterate.stress.begin(),
                                                   iterate.stress.end()),
                                 now.tension,
                                 now.crushing) -
          now.crushing;
        return iterate;
      }

      /** The iterate on the yield surface, by regula falsi (Illinois). */
      Iterate
      return_mapping(const Principal &trial,
                     const double     opening,
                     const double     crushing,
                     const double     length) const
      {
        const auto at = [&](const double progress) {
          return iterate_at(trial, opening, crushing, length, progress);
        };
        double  left = 0., right = 1.;
        Iterate iterate     = at(left);
        double  left_excess = iterate.excess;
        if (left_excess <= 0.)
          {
            iterate.stress = trial; // without round-off
            return iterate;
          }
        iterate             = at(right);
        double right_excess = iterate.excess;
        if (right_excess > 0.)
          {
            left         = right;
            left_excess  = right_excess;
            right        = 2.;
            iterate      = at(right);
            right_excess = iterate.excess;
          }
        const double tolerance = 1e-13 * (yield_strength + left_excess);
        int          side      = 0; // of the last point
        while (std::abs(iterate.excess) > tolerance &&
               right - left > 1e-15 * right)
          {
            const double progress =
              (left * right_excess - right * left_excess) /
              (right_excess - left_excess);
            iterate = at(progress);
            if (iterate.excess > 0.)
              {
                left        = progress;
                left_excess = iterate.excess;
                if (side > 0)
                  right_excess *= 0.5;
                side = 1;
              }
            else
              {
                right        = progress;
                right_excess = iterate.excess;
                if (side < 0)
                  left_excess *= 0.5;
                side = -1;
              }
          }
        return iterate;
      }

      template <typename Number>
      PointResponse<Number>
      respond(const SymmetricTensor3<Number> &strain,
              Number                         *history,
              const PointSituation<Number>   &situation) const
      {
        const SymmetricTensor3<Number> plastic   = tensor_of(history);
        const SymmetricTensor3<Number> trial     = stress(strain - plastic);
        auto                           principal = spectrum(trial);

        std::array<Number, 3> excess;
        // 1 - D before and after the step
        Number tension_before = 1., tension_now = 1., crushing_before = 1.,
               crushing_now = 1.;
        for (unsigned int lane = 0; lane < n_lanes<Number>(); ++lane)
          {
            const double length  = lane_of(situation.element_length, lane);
            double      &opening = lane_of(history[6], lane),
                   &crushing     = lane_of(history[7], lane);
            Principal s;
            for (unsigned int i = 0; i < 3; ++i)
              s[i] = lane_of(principal.values[i], lane);
            const Iterate iterate =
              return_mapping(s, opening, crushing, length);
            const Strengths before = strengths(opening, crushing, length),
                            now    = strengths(iterate.opening,
                                            iterate.crushing,
                                            length);
            lane_of(tension_before, lane)  = before.tension_intact;
            lane_of(tension_now, lane)     = now.tension_intact;
            lane_of(crushing_before, lane) = before.crushing_intact;
            lane_of(crushing_now, lane)    = now.crushing_intact;
            for (unsigned int i = 0; i < 3; ++i)
              lane_of(excess[i], lane) = s[i] - iterate.stress[i];
            opening  = iterate.opening;
            crushing = iterate.crushing;
          }

        const SymmetricTensor3<Number> effective_excess =
          principal.compose(excess);
        const SymmetricTensor3<Number> effective = trial - effective_excess;
        const SymmetricTensor3<Number> increment =
          this->strain(effective_excess);
        for (unsigned int i = 0; i < 6; ++i)
          history[i] += increment.access_raw_entry(i);

        for (unsigned int i = 0; i < 3; ++i)
          principal.values[i] -= excess[i];
        const auto                     split = split_tension(principal, *this);
        const SymmetricTensor3<Number> closed =
          recovery * split.principal.compose(split.compression);
        const auto weakened = [&](const Number &tension_intact,
                                  const Number &crushing_intact) {
          return SymmetricTensor3<Number>(
            crushing_intact *
            (tension_intact * effective + (1. - tension_intact) * closed));
        };

        PointResponse<Number> response(strain);
        response.stress         = weakened(tension_now, crushing_now);
        response.elastic_strain = strain - plastic - increment;
        response.damping_share  = tension_now * crushing_now;
        const SymmetricTensor3<Number> before =
          weakened(tension_before, crushing_before);
        response.dissipation =
          0.5 * ((before + response.stress) * increment +
                 (before - response.stress) * response.elastic_strain);
        response.plastic_increment = increment;
        return response;
      }

      static std::vector<std::string>
      output_names()
      {
        return {OutputName::tension_damage,
                OutputName::compression_damage,
                OutputName::largest_opening};
      }

      std::vector<double>
      outputs(const double *history, const double element_length) const
      {
        const Strengths now = strengths(history[6], history[7], element_length);
        return {1. - now.tension_intact,
                1. - now.crushing_intact,
                1e3 * element_length * history[6]};
      }
    };

    const Registry<Material>::Add<MaterialOf<LeeFenves>> registered_lee_fenves(
      "lee-fenves",
      "Concrete with plastic strain and damage in tension and compression "
      "after Lee and Fenves (1998), modified: a closing crack regains its "
      "stiffness in the compressed directions only, so that the stress has a "
      "potential.");
  } // namespace
} // namespace Voussoir
