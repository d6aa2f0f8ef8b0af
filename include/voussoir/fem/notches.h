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


  /** The sharpest notch of a cell. */
  struct Notch
  {
    double angle = 0.; // w, filled by the solid; zero: no notch [rad]

    /** Whether the middle of this angle is a face between two cells, as an even
     *  number of cells meets at the edge. */
    bool is_between_cells = false;
  };


  /**
   * Notches of the owned cells, in the order of Grid::owned_cell. They are
   * edges of the mesh at which its outer faces meet at more than 200 degrees;
   * below that they are taken for pieces of a curved face. The end of an
   * interface is none, as its sides transmit traction.
   */
  std::vector<Notch>
  notches_of_cells(const Grid &grid);


  /** Whether cracks of one of the materials grow from tips or along planes. */
  bool
  any_cracks_grow(const std::vector<const CellKernel *> &kernels);


  /**
   * Factor on the tensile strength at which a first crack begins in a cell at a
   * notch. A cell averages the stress r^-s of a notch as it does the r^-1/2 of
   * the tip of a crack, so that the factor f(h) at a tip in a cell of size h
   * becomes f(c h)^(2s). Unlike the tip of a crack, in the middle of a face, a
   * notch is at an edge of the cell. Fitted to plates (doc/damage.md): c = 2
   * where the notch points at a face between two cells, 2 (w / 2 pi)^4 where it
   * points into a cell.
   *
   * @return one without a notch, and where cracks do not grow from tips or
   *   along planes
   */
  double
  strength_at_notch(const CellKernel &kernel,
                    const Notch      &notch,
                    const double      cell_size);


  /** Gives the cells at notches this strength.
   *  @param memory empty: materials are elastic */
  void
  weaken_at_notches(const Discretization                  &discretization,
                    const std::vector<const CellKernel *> &kernels,
                    MaterialMemory                        &memory);
} // namespace Voussoir

#endif
