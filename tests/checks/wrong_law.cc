// GCC 12 finds "uninitialized" variables in its own AVX-512 intrinsics.
#pragma GCC diagnostic ignored "-Wuninitialized"

#include <voussoir/materials/isotropic_elasticity.h>
#include <voussoir/materials/material_of.h>

#include "march_with_energy.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Isotropic damage by the energy norm of the effective stress, whose stress
     * falls exponentially, and which reports a share of its dissipation.
     */
    struct TellingDamage : IsotropicElasticity
    {
      // largest norm so far and that of the last step [Pa]
      static constexpr unsigned int n_history = 2;

      double strength = 2e6, fracture_energy = 200., reported = 1.;

      void
      declare_parameters(ParameterHandler &prm)
      {
        IsotropicElasticity::declare_parameters(prm);
        prm.add_parameter("Strength", strength, "ft [Pa].");
        prm.add_parameter("Fracture energy", fracture_energy, "Gf [N/m].");
        prm.add_parameter("Reported", reported, "Share of the dissipation.");
      }

      template <typename Number>
      Number
      norm(const SymmetricTensor3<Number> &stress) const
      {
        return std::sqrt(Number(young_modulus * (stress * strain(stress))));
      }

      template <typename Number>
      Number
      yield_ratio(const SymmetricTensor3<Number> &stress, const Number &) const
      {
        return norm(stress) / strength;
      }

      template <typename Number>
      PointResponse<Number>
      respond(const SymmetricTensor3<Number> &strain,
              Number                         *history,
              const PointSituation<Number>   &situation) const
      {
        const SymmetricTensor3<Number> elastic = stress(strain);
        const Number limit = strength, last = std::max(limit, history[1]);
        const Number before = std::max(limit, history[0]);
        const Number at_end = norm(elastic), now = std::max(before, at_end);
        // int sigma de = Gf / l
        const Number slope =
          1. / (fracture_energy * young_modulus /
                  (situation.element_length * strength * strength) -
                0.5);
        const auto intact = [&](const Number &r) {
          return Number(limit / r * std::exp(Number(slope * (1. - r / limit))));
        };
        using Comparison         = SIMDComparison;
        const auto where_damaged = [&](const Number &value) {
          return compare_and_apply_mask<Comparison::greater_than>(now,
                                                                  limit,
                                                                  value,
                                                                  Number(0.));
        };
        history[0] = where_damaged(now);
        history[1] = where_damaged(at_end);

        PointResponse<Number> response(strain);
        response.stress = intact(now) * elastic;
        // of the trapezoidal rule along a straight path
        response.dissipation = reported * 0.5 * (intact(before) - intact(now)) *
                               last * at_end / young_modulus;
        response.damping_share = intact(now);
        return response;
      }
    };

    const Registry<Material>::Add<MaterialOf<TellingDamage>>
      material("telling damage", "Damage that reports a share of its losses.");


    /**
     * A bar with a weak layer of a law that reports less or more than it
     * dissipates is pulled apart: the difference is the energy-balance error.
     * The dissipation of the law is the work of the traction on the opening.
     */
    class WrongLaw : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Crack energy", crack_energy, "Gf A [J].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string ratio : {"0", "0.05", "0.12"})
          for (const std::string reported : {"1", "0.7", "1.2"})
            {
              const auto parameters =
                make_case(file.with({"Damping/Ratio=" + ratio,
                                     "Materials/weak/Reported=" + reported}));
              const auto simulation =
                make_simulation(*parameters, communicator);
              Run &run = simulation->run;
              march_with_energy(run, [](const bool) {});
              const auto        summary = run.energy.summary();
              const std::string name =
                "damping " + ratio + ", reported " + reported + ": ";
              verdicts.near(name + "reported",
                            summary.terms.material,
                            std::stod(reported) * crack_energy,
                            0.01,
                            "J");
              const double error = summary.error;
              verdicts.below(
                name + "energy-balance error less what is not reported, over "
                       "the crack's energy",
                error / crack_energy - (1. - std::stod(reported)),
                0.01);
            }
      }

    private:
      double crack_energy = 0.;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<WrongLaw>
      registered("wrong law",
                 "A law that loses more than it reports is found.");
  } // namespace
} // namespace Voussoir
