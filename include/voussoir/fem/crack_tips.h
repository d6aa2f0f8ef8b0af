#ifndef voussoir_fem_crack_tips_h
#define voussoir_fem_crack_tips_h

#include <voussoir/fem/cell_kernel.h>

namespace Voussoir
{
  /**
   * Where cracks run on. A crack of smeared damage goes from cell to cell, and
   * a cell averages the high stress at the tip: with the strength of the
   * material, a crack in cells that are not much smaller than E Gf / ft^2 runs
   * at up to half as much load again as in truth. Hence cells beside a cracked
   * one, if its plane cuts the face between them, have the strength that the
   * law of their material gives a cell of their size, whatever material the
   * crack comes from; all others have that of the material. The plane goes
   * through the centre of the cracked cell, across the mean normal of the
   * points that have cracked when that is seen.
   *
   * A cell that has once been at a tip stays so. Cracks do not run on across
   * joints, whose two sides are no neighbours in the mesh.
   */
  class CrackTips
  {
  public:
    /** @param kernels of each material; must live as long as this */
    CrackTips(const Discretization                  &discretization,
              const std::vector<const CellKernel *> &kernels);

    /** Looks for new cracks after every fourth step, and lets them run on. */
    void
    look(const unsigned long long step, MaterialMemory &memory) const;

  private:
    using Cell = Discretization::Cell;

    struct Crack
    {
      Cell                 cell;
      dealii::Tensor<1, 3> normal;
    };

    /** Cracks of own cells that have not been seen yet. */
    std::vector<Crack>
    new_cracks(MaterialMemory &memory) const;

    /** Adds the cracks of ghost cells. */
    void
    exchange(std::vector<Crack> &cracks) const;

    void
    run_on(const Crack &crack, MaterialMemory &memory) const;

    /** Gives an own cell the strength of a tip. */
    void
    weaken(const Cell &cell, MaterialMemory &memory) const;

    const Discretization           &discretization;
    std::vector<const CellKernel *> kernels;
    std::vector<bool>               follows_tips; // each material
    std::vector<bool>               is_shared;    // vertices of ghost cells
  };
} // namespace Voussoir

#endif
