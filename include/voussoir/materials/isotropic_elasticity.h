#ifndef voussoir_materials_isotropic_elasticity_h
#define voussoir_materials_isotropic_elasticity_h

#include <voussoir/materials/law.h>

namespace Voussoir
{
  /**
   * Damage at the modulus E that has the stress and the inelastic strain of a
   * damage d at the modulus a E of the static state: the effective strain is
   * multiplied by a (1 - d + d/a) , and the damage d' = (d/a) / (1 - d + d/a) .
   */
  struct DamageHandedOver
  {
    DamageHandedOver(const double damage, const double static_factor)
      : damage(damage / static_factor / (1. - damage + damage / static_factor))
      , strain_factor(static_factor * (1. - damage + damage / static_factor))
    {}

    double damage, strain_factor;
  };


  /** Hooke's law, sigma = lambda tr(epsilon) I + 2 G epsilon: the base of
   *  isotropic laws. */
  struct IsotropicElasticity : LawDefaults
  {
    double young_modulus = 24e9; // E [Pa]
    double poisson_ratio = 0.2;  // nu

    void
    declare_parameters(dealii::ParameterHandler &prm);

    void
    set_static(const double factor)
    {
      young_modulus *= factor;
    }

    double
    shear_modulus() const // G [Pa]
    {
      return young_modulus / (2. * (1. + poisson_ratio));
    }

    double
    bulk_modulus() const // K [Pa]
    {
      return young_modulus / (3. * (1. - 2. * poisson_ratio));
    }

    template <typename Number>
    SymmetricTensor3<Number>
    stress(const SymmetricTensor3<Number> &strain) const
    {
      const double two_shear = young_modulus / (1. + poisson_ratio);
      const double lambda =
        two_shear * poisson_ratio / (1. - 2. * poisson_ratio);
      SymmetricTensor3<Number> result   = two_shear * strain;
      const Number             pressure = lambda * trace(strain);
      for (unsigned int d = 0; d < 3; ++d)
        result[d][d] += pressure;
      return result;
    }

    /** The strain of a stress. */
    template <typename Number>
    SymmetricTensor3<Number>
    strain(const SymmetricTensor3<Number> &stress) const
    {
      SymmetricTensor3<Number> result =
        ((1. + poisson_ratio) / young_modulus) * stress;
      const Number part = (poisson_ratio / young_modulus) * trace(stress);
      for (unsigned int d = 0; d < 3; ++d)
        result[d][d] -= part;
      return result;
    }

    /** The strain with the same stress and inelastic strain as @p strain has in
     *  the static state. */
    SymmetricTensor3<double>
    strain_handed_over(const SymmetricTensor3<double> &strain,
                       const SymmetricTensor3<double> &stress,
                       const double                    static_factor) const
    {
      return strain + (1. - 1. / static_factor) * this->strain(stress);
    }
  };
} // namespace Voussoir

#endif
