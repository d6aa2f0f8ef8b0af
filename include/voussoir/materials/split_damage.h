#ifndef voussoir_materials_split_damage_h
#define voussoir_materials_split_damage_h

#include <voussoir/materials/softening_curve.h>
#include <voussoir/materials/tension_split.h>

namespace Voussoir
{
  /**
   * What laws with two scalar damages of the effective stress s = C : e_e have
   * in common, which is split into tension and compression (see split_tension):
   *   sigma = (1 - d+) s+ + (1 - d-) s- .
   * Each damage follows a uniaxial curve from the largest equivalent stress of
   * its own so far, so that a step needs no iteration, and a crack that closes
   * has its stiffness back.
   */
  struct SplitDamage : IsotropicElasticity, TensileCrack
  {
    SofteningCurve tension, compression;

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
    }

    std::string
    remark(const double element_length) const
    {
      return tension.remark(element_length);
    }

    /** What a step does in tension and in compression, or to their parts. */
    template <typename T>
    using OfBoth = std::array<T, 2>;

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
