#ifndef voussoir_analysis_lost_equilibrium_h
#define voussoir_analysis_lost_equilibrium_h

#include <voussoir/base/error.h>
#include <voussoir/constraints/contact.h>

namespace Voussoir
{
  /** A static stage under whose loads a block slides or falls, or cracks or
   *  plastic flow do not end. */
  class LostEquilibrium : public RunStopped
  {
  public:
    /**
     * @param before displacement at the end of the stage before [m]
     * @param moved displacement at which the search for equilibrium was given
     *   up
     */
    LostEquilibrium(const std::string &what,
                    const Vector      &before,
                    const Vector      &moved);

    const Vector before, moved;
  };

  /**
   * Which parts move without end, as far as can be determined: the surfaces
   * none of whose points sticks, by how much they have slipped and opened, and
   * where the model has moved most. Called on all ranks.
   *
   * @param contact null without interfaces
   * @param cracks  whether materials have cracked or yielded
   */
  std::string
  description_of_motion(const Discretization &discretization,
                        const Contact        *contact,
                        const Vector         &before,
                        const Vector         &moved,
                        const bool            cracks);
} // namespace Voussoir

#endif
