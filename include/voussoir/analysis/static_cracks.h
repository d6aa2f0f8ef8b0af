#ifndef voussoir_analysis_static_cracks_h
#define voussoir_analysis_static_cracks_h

#include <voussoir/fem/crack_planes.h>
#include <voussoir/fem/crack_tips.h>

namespace Voussoir
{
  /** Propagation of cracks from cell to cell in the static state. */
  struct StaticCracks
  {
    /** @param kernels of the static state
     *  Arguments must live as long as this. */
    StaticCracks(const Discretization                  &discretization,
                 const std::vector<const CellKernel *> &kernels,
                 const InternalForce                   &internal_force,
                 const Damping                         &damping);

    /** Finds new cracks in an equilibrium, and lets them propagate; returns
     *  whether the equilibrium has to be found again. Called on all ranks. */
    bool
    propagate(const Vector &displacement, MaterialMemory &memory);

    CrackTips   tips;
    CrackPlanes planes;
  };
} // namespace Voussoir

#endif
