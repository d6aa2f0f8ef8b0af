#ifndef voussoir_materials_isotropic_elasticity_h
#define voussoir_materials_isotropic_elasticity_h

#include <voussoir/materials/law.h>

namespace Voussoir
{
  /** Hooke's law, sigma = lambda tr(epsilon) I + 2 G epsilon: what isotropic
   *  laws begin with. */
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
  };
} // namespace Voussoir

#endif
