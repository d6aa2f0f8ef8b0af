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
   * Angle w that the solid fills at the sharpest notch of each owned cell, in
   * the order of Grid::owned_cell; zero at none [rad]. Notches are edges of the
   * mesh at which its outer faces meet at more than 200 degrees; below that
   * they are taken for pieces of a curved face. The end of an interface is
   * none, as its sides transmit traction.
   */
  std::vector<double>
  angles_at_notches(const Grid &grid);


  /**
   * Factor on the tensile strength at which a first crack begins in a cell at a
   * notch. A cell averages the stress r^-s of a notch as it does the r^-1/2 of
   * the tip of a crack, so that the factor f(h) at a tip in a cell of size h
   * becomes f(c h)^(2s). Unlike the tip of a crack, in the middle of a face, a
   * notch is at an edge of the cell: c = 2 (w / 2 pi)^4, fitted to plates with
   * a slit and with a corner of 270 degrees (doc/damage.md).
   *
   * @param angle as in angles_at_notches [rad]
   * @return one without a notch, and where cracks do not grow from tips or
   *   along planes
   */
  double
  strength_at_notch(const CellKernel &kernel,
                    const double      angle,
                    const double      cell_size);


  /** Gives the cells at notches this strength.
   *  @param memory empty: materials are elastic */
  void
  weaken_at_notches(const Discretization                  &discretization,
                    const std::vector<const CellKernel *> &kernels,
                    MaterialMemory                        &memory);
} // namespace Voussoir

#endif
