#ifndef voussoir_fem_notches_h
#define voussoir_fem_notches_h

#include <voussoir/fem/cell_kernel.h>

namespace Voussoir
{
  /**
   * Order s of the stress r^-s around an edge at which an elastic solid between
   * two free faces fills an angle w, in opening: with the smallest root k of
   *   sin(k w) + k sin(w) = 0
   * it is 1 - k (Williams 1952); 1/2 at the end of a slit, where w = 2 pi, and
   * zero up to w = pi.
   *
   * @param angle w [rad]
   */
  double
  order_of_singularity(const double angle);


  /**
   * Factor on the tensile strength of each owned cell at which a first crack
   * begins at a notch, in the order of Grid::owned_cell; one elsewhere, and
   * where the cracks of the material do not grow from tips or along planes.
   *
   * Notches are edges of the mesh at which its outer faces meet at more than
   * 200 degrees; below that they are taken for pieces of a curved face. The end
   * of an interface is none, as its sides transmit traction. A cell averages
   * the stress r^-s of a notch as it does the r^-1/2 of the tip of a crack, so
   * that the factor f(h) at a tip in a cell of size h becomes f(c h)^(2s). The
   * tip of a crack enters a cell in the middle of a face, a slit ends at an
   * edge of it: c rises from 1 at 270 degrees to 2 at a slit. doc/damage.md has
   * the trials.
   *
   * @param kernels of each material
   */
  std::vector<double>
  strength_at_notches(const Grid                            &grid,
                      const std::vector<const CellKernel *> &kernels);


  /** Gives the cells at notches this strength.
   *  @param memory empty: materials are elastic */
  void
  weaken_at_notches(const Discretization                  &discretization,
                    const std::vector<const CellKernel *> &kernels,
                    MaterialMemory                        &memory);
} // namespace Voussoir

#endif
