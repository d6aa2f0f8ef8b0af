#ifndef voussoir_fem_state_h
#define voussoir_fem_state_h

#include <voussoir/fem/point_history.h>

namespace Voussoir
{
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

    double             time = 0.; // [s]
    unsigned long long step = 0;
  };
} // namespace Voussoir

#endif
