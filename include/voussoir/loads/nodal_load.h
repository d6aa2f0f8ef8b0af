#ifndef voussoir_loads_nodal_load_h
#define voussoir_loads_nodal_load_h

#include <voussoir/fem/nodal_terms.h>
#include <voussoir/fem/state.h>

namespace Voussoir
{
  /**
   * What puts forces on nodes while the model moves: a load, the free field at
   * the absorbing boundary, water. The step walks a list of them.
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

    /** Called with the state at the end of each step, for what moves beside the
     *  solid. */
    virtual void
    end_step(const State &)
    {}
  };
} // namespace Voussoir

#endif
