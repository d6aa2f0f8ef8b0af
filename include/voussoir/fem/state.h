#ifndef voussoir_fem_state_h
#define voussoir_fem_state_h

#include <voussoir/base/sum.h>
#include <voussoir/fem/point_history.h>

namespace Voussoir
{
  /**
   * Energy that nodal vectors have supplied and dissipated since the start, of
   * this rank [J]. Energy of the cells is in the internal variables of their
   * points and in the energy balance.
   */
  struct EnergyAccounts
  {
    EnergyAccounts() = default;

    explicit EnergyAccounts(const bool exact)
      : work_of_forces(exact)
      , work_of_base(exact)
      , work_of_projections(exact)
      , loss_in_dashpots(exact)
      , loss_by_mass(exact)
    {}

    Sum work_of_forces;      // also of the ground on added mass
    Sum work_of_base;        // inertia under a moving rigid base
    Sum work_of_projections; // contact, prescribed motion
    Sum loss_in_dashpots;    // of the absorbing boundary
    Sum loss_by_mass;        // mass-proportional damping
  };

  /** All quantities that change with time, which are the contents of a
   *  checkpoint. */
  struct State
  {
    /** Displacement u_n at `time` [m]. */
    Vector displacement;

    /** Velocity of the half step before, (u_n - u_(n-1)) / dt [m/s]. */
    Vector velocity;

    /** Damping memory w_i, one vector per Maxwell branch [m]. */
    std::vector<Vector> memory;

    /** Internal variables of the materials; empty: they are elastic. */
    MaterialMemory material_memory;

    EnergyAccounts accounts;

    double             time = 0.; // [s]
    unsigned long long step = 0;
  };
} // namespace Voussoir

#endif
