#ifndef voussoir_fem_state_h
#define voussoir_fem_state_h

#include <voussoir/fem/point_history.h>

namespace Voussoir
{
  /**
   * What has come in and been lost since the start by way of nodal vectors, of
   * this rank [J]. Energy that the cells take is in the memory of their points
   * and in the energy balance.
   */
  struct EnergyAccounts
  {
    double work_of_forces      = 0.; // also of the ground on added mass
    double work_of_base        = 0.; // inertia under a moving rigid base
    double work_of_projections = 0.; // contact, prescribed motion
    double loss_in_dashpots    = 0.; // of the absorbing boundary
    double loss_by_mass        = 0.; // mass-proportional damping
  };

  /** All that changes with time; a checkpoint holds these and nothing else. */
  struct State
  {
    /** Displacement u_n at `time` [m]. */
    Vector displacement;

    /** Velocity of the half step before, (u_n - u_(n-1)) / dt [m/s]. */
    Vector velocity;

    /** Damping memory w_i, one vector per Maxwell branch [m]. */
    std::vector<Vector> memory;

    /** What the points of the materials remember; empty: they are elastic. */
    MaterialMemory material_memory;

    EnergyAccounts accounts;

    double             time = 0.; // [s]
    unsigned long long step = 0;
  };
} // namespace Voussoir

#endif
