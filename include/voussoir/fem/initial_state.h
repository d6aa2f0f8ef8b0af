#ifndef voussoir_fem_initial_state_h
#define voussoir_fem_initial_state_h

#include <voussoir/fem/point_history.h>

namespace Voussoir
{
  /**
   * State after the loads before the earthquake. Displacements in a run are
   * totals, which begin with these; stresses begin with
   *   k D : (epsilon(u) - alpha T I)
   * for the static factor k of the material (see Material::elastic_strain).
   */
  struct InitialState
  {
    /** Displacement of the static stage [m]; zero without one. */
    Vector displacement;

    /** Displacement when the last interfaces were grouted [m]; empty if none
     *  were. */
    Vector grouted_displacement;

    /** Displacement after each static stage, by the names of its loads [m]. */
    std::vector<std::pair<std::string, Vector>> stages;

    /** Change of temperature since the joints were closed, of each node in all
     *  three components [K]. */
    Vector temperature;

    /** Reactions of the supports of the static stages [N]; nearly zero where
     *  nodes are free. */
    Vector reaction;

    /** Loads and reactions of the static stage, which stay constant, with the
     *  moduli of the run [N]; see hand_over. */
    Vector force;

    /** Forces of contact in the static state, which are no part of `force`,
     *  since the run computes them [N]; empty without interfaces. */
    Vector contact_force;

    /** Internal variables of the materials in the static state, with which
     *  every run begins; empty: they are elastic. */
    MaterialMemory material_memory;
  };
} // namespace Voussoir

#endif
