// the kernels of a law use intrinsics in which GCC finds uninitialized numbers
#pragma GCC diagnostic ignored "-Wuninitialized"

#include <voussoir/materials/isotropic_elasticity.h>
#include <voussoir/materials/material_of.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A law with internal variables that takes all defaults of LawDefaults:
     *  above all, it has no yield_ratio. The energy norm of its stress is
     *  bounded by a limit. */
    struct Plain : IsotropicElasticity
    {
      static constexpr unsigned int n_history = 1; // largest norm so far [Pa]
      static constexpr double       strength  = 2e6;

      template <typename Number>
      PointResponse<Number>
      respond(const SymmetricTensor3<Number> &strain,
              Number                         *history,
              const PointSituation<Number> &) const
      {
        const SymmetricTensor3<Number> elastic = stress(strain);
        const Number                   limit   = strength;
        const Number                   before  = std::max(limit, history[0]);
        const Number                   now =
          std::max(before,
                   Number(
                     std::sqrt(Number(young_modulus * (elastic * strain)))));
        history[0] = compare_and_apply_mask<SIMDComparison::greater_than>(
          now, limit, now, Number(0.));
        PointResponse<Number> response(strain);
        response.stress        = limit / now * elastic;
        response.damping_share = limit / now;
        response.dissipation   = 0.5 * (elastic * strain) *
                               (limit / before - limit / now) * before / now;
        return response;
      }
    };


    /** The tests of all materials for a law that takes all defaults. */
    class LawDefaultsCheck : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        auto      &entries = Registry<Material>::entries();
        const auto known   = entries;
        entries.clear();
        // under the name that is the default of every material
        entries["linear elastic"] = {
          "A law without yield ratio.",
          [] { return std::make_unique<MaterialOf<Plain>>(); }};
        Registry<Check>::create("materials", "")
          ->run(file, verdicts, communicator);
        entries = known;
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<LawDefaultsCheck>
      registered("law defaults", "A law with none of the optional members.");
  } // namespace
} // namespace Voussoir
