#ifndef voussoir_fem_stiffness_factors_h
#define voussoir_fem_stiffness_factors_h

namespace Voussoir
{
  /**
   * What a stage of the computation makes of the moduli of a material. By
   * default they are as given, without damping: what natural modes go by.
   */
  struct StiffnessFactors
  {
    /** k on the stress. Under damping it lets the moduli hold at the reference
     *  frequency; in the static stage it is the static factor. */
    double stress = 1.;

    /** m on the strain that a law with memory sees: the static factor in the
     *  static stage, else one. */
    double strain = 1.;
  };
} // namespace Voussoir

#endif
