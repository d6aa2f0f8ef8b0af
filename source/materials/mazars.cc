// Concrete with a single damage.

#include <voussoir/base/error.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/materials/isotropic_elasticity.h>
#include <voussoir/materials/material_of.h>
#include <voussoir/materials/softening_curve.h>
#include <voussoir/materials/spectral.h>
#include <voussoir/materials/tension_split.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The model of Mazars (1986): one damage D of the whole stiffness,
     *   sigma = (1 - D) C : e ,   D = a_t D_t + a_c D_c ,
     * driven by the largest of sqrt(sum <e_i>^2) over the principal strains.
     * Of these strains, a_t is the share due to the tensile principal stresses.
     * D_t follows the exponential curve of a crack band; in compression
     *   D_c = 1 - (1 - A) k0 / k - A exp(-B (k - k0)) ,   k0 = ft / E.
     * A closing crack does not regain its stiffness: the model is for monotonic
     * loads, not for cycles.
     */
    struct Mazars : IsotropicElasticity, TensileCrack
    {
      // largest equivalent strain, damage, and the CurveMemory of D_t
      static constexpr unsigned int n_history = 2 + CurveMemory::n_numbers;

      double share = 1.1;   // A
      double rate  = 1500.; // B

      SofteningCurve tension;

      void
      declare_parameters(ParameterHandler &prm)
      {
        IsotropicElasticity::declare_parameters(prm);
        TensileCrack::declare_parameters(prm);
        prm.add_parameter("Compression A",
                          share,
                          "Coefficient A of the damage in compression, usually "
                          "1 to 1.5.",
                          Patterns::Double(0., 3.));
        prm.add_parameter("Compression B",
                          rate,
                          "Coefficient B of the damage in compression, 1000 to "
                          "2000 for concrete [-]." +
                            usually(Usual::compression_coefficient),
                          Patterns::Double(1.));
      }

      void
      check(const std::string &place)
      {
        tension = SofteningCurve(SofteningCurve::exponential(tensile_strength,
                                                             fracture_energy),
                                 young_modulus,
                                 0.);
        const double threshold = tensile_strength / young_modulus;
        if (share - 1. > share * rate * threshold)
          throw UserError(
            place + ": with these values of \"Compression A\" and "
                    "\"Compression B\" the damage would begin below zero; "
                    "raise B or lower A.");
      }

      void
      set_static(const double factor)
      {
        IsotropicElasticity::set_static(factor);
        tension = tension.of_static_state(young_modulus);
      }

      TensileFailure
      tensile_failure() const
      {
        return tension.failure();
      }

      /** Stress and inelastic strain are kept, as in SplitDamage. */
      SymmetricTensor3<double>
      hand_over(const SymmetricTensor3<double> &strain,
                const PointResponse<double>    &response,
                double                         *history,
                const double                    element_length,
                const double                    static_factor) const
      {
        const DamageHandedOver now(history[1], static_factor),
          in_tension(history[5], static_factor);
        CurveMemory memory{};
        if (history[2] > 0.)
          tension.hand_over(in_tension.damage,
                            history[4] * in_tension.strain_factor,
                            element_length,
                            memory);
        history[0] *= now.strain_factor;
        history[1] = now.damage;
        history[2] = memory.largest;
        history[3] = memory.position;
        history[4] = memory.last;
        history[5] = memory.damage;
        return strain_handed_over(strain, response.stress, static_factor);
      }

      template <typename Number>
      Number
      yield_ratio(const SymmetricTensor3<Number> &stress,
                  const Number                   &element_length) const
      {
        // principal strains lie within mean +- 2 sqrt(J2 / 3) / (2 G)
        const auto [first, second] = invariants(stress);
        const Number largest       = first / (9. * bulk_modulus()) +
                               std::sqrt(Number(second / 3.)) / shear_modulus();
        return std::sqrt(3.) * largest * young_modulus /
               (tensile_strength * tension.strength_factor(element_length));
      }

      double
      damage_in_compression(const double strain, const double threshold) const
      {
        return std::max(0.,
                        1. - (1. - share) * threshold / strain -
                          share * std::exp(-rate * (strain - threshold)));
      }

      template <typename Number>
      PointResponse<Number>
      respond(const SymmetricTensor3<Number> &strain,
              Number                         *history,
              const PointSituation<Number>   &situation) const
      {
        const SymmetricTensor3<Number> effective = stress(strain);
        const auto                     principal = spectrum(effective);

        Number positive_trace = 0., squares = 0., in_tension = 0.;
        for (unsigned int i = 0; i < 3; ++i)
          positive_trace += std::max(principal.values[i], Number(0.));
        const Number trace =
          principal.values[0] + principal.values[1] + principal.values[2];
        for (unsigned int i = 0; i < 3; ++i)
          {
            // strain of a stress along its direction i
            const auto along = [&](const Number &value, const Number &sum) {
              return Number(
                ((1. + poisson_ratio) * value - poisson_ratio * sum) /
                young_modulus);
            };
            const Number extension =
              std::max(along(principal.values[i], trace), Number(0.));
            squares += extension * extension;
            in_tension +=
              extension *
              along(std::max(principal.values[i], Number(0.)), positive_trace);
          }

        Number intact = 1., lost = 0.;
        for (unsigned int lane = 0; lane < n_lanes<Number>(); ++lane)
          {
            const double band       = lane_of(situation.element_length, lane),
                         equivalent = std::sqrt(lane_of(squares, lane)),
                         threshold  = tension.elastic_limit(band);
            double &largest         = lane_of(history[0], lane),
                   &damage          = lane_of(history[1], lane);
            const double start      = std::max(largest, threshold);
            CurveMemory  memory{lane_of(history[2], lane),
                               lane_of(history[3], lane),
                               lane_of(history[4], lane),
                               lane_of(history[5], lane)};
            const double last   = memory.largest > 0. ? memory.last : threshold,
                         before = damage, before_in_tension = memory.damage;
            DamageProgress<double> progress;
            if (equivalent > start || memory.largest > 0.)
              progress =
                tension.go_on(young_modulus * equivalent, memory, band);
            if (equivalent > start)
              {
                largest = equivalent;
                const double weight =
                  std::max(0.,
                           std::min(1.,
                                    lane_of(in_tension, lane) /
                                      lane_of(squares, lane)));
                damage =
                  std::max(damage,
                           weight * memory.damage +
                             (1. - weight) *
                               damage_in_compression(largest, threshold));
                // the loss is proportional to that of D_t, which in the static
                // state follows its curve
                const double growth = memory.damage - before_in_tension;
                lane_of(lost, lane) =
                  (damage - before) * (growth > 0. ?
                                         progress.dissipation / growth :
                                         last / largest);
              }
            lane_of(history[2], lane) = memory.largest;
            lane_of(history[3], lane) = memory.position;
            lane_of(history[4], lane) = memory.last;
            lane_of(history[5], lane) = memory.damage;
            lane_of(intact, lane)     = 1. - damage;
          }

        PointResponse<Number> response(strain);
        response.stress        = intact * effective;
        response.dissipation   = 0.5 * lost * (effective * strain);
        response.damping_share = intact;
        return response;
      }

      static std::vector<std::string>
      output_names()
      {
        return {"damage", OutputName::largest_opening};
      }

      std::vector<double>
      outputs(const double *history, const double element_length) const
      {
        return {history[1], 1e3 * element_length * history[1] * history[0]};
      }

      std::string
      remark(const double element_length) const
      {
        return tension.remark(element_length);
      }
    };

    const Registry<Material>::Add<MaterialOf<Mazars>> registered_mazars(
      "mazars",
      "Concrete with one damage after Mazars (1986), for monotonic loads: "
      "closing cracks do not regain their stiffness.");
  } // namespace
} // namespace Voussoir
