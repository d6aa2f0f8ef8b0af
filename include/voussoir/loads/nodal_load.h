#ifndef voussoir_loads_nodal_load_h
#define voussoir_loads_nodal_load_h

#include <voussoir/fem/nodal_terms.h>
#include <voussoir/fem/state.h>

namespace Voussoir
{
  /**
   * Forces on nodes during the motion: a load, the free field at the absorbing
   * boundary, water. The time step iterates over a list of them.
   */
  class NodalLoad
  {
  public:
    virtual ~NodalLoad() = default;

    /** Adds its forces at the beginning of a step, at @p time [s], to those of
     *  nodes that have terms [N]. */
    virtual void
    add_forces(const double, NodalForces &)
    {}

    /** Called with the state at the end of each step, for parts with a motion
     *  of their own. */
    virtual void
    end_step(const State &)
    {}
  };
} // namespace Voussoir

#endif
