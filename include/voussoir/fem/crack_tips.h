#ifndef voussoir_fem_crack_tips_h
#define voussoir_fem_crack_tips_h

#include <voussoir/fem/cell_kernel.h>

namespace Voussoir
{
  /**
   * Tips of cracks. A crack of smeared damage propagates from cell to cell, and
   * a cell averages the high stress at the tip: with the strength of the
   * material, a crack in cells that are not much smaller than E Gf / ft^2
   * propagates at up to 1.4 times the correct load. Hence the neighbours of a
   * cracked cell, where the plane of its crack cuts the common face, have the
   * strength that the law of their own material gives a cell of their size; all
   * other cells have the strength of the material. The plane goes through the
   * centre of the cracked cell; its normal is the mean of the normals of the
   * points that have cracked when the crack is found.
   *
   * A cell that has once been at a tip keeps this strength. Cracks do not
   * propagate across joints, whose two sides are no neighbours in the mesh.
   */
  class CrackTips
  {
  public:
    /** @param kernels of each material; must live as long as this */
    CrackTips(const Discretization                  &discretization,
              const std::vector<const CellKernel *> &kernels);

    /** Finds new cracks after every fourth step, and weakens the cells at their
     *  tips. */
    void
    update(const unsigned long long step, MaterialMemory &memory) const;

    /** Finds new cracks and weakens the cells at their tips; returns whether
     *  any own cell has become weaker. Called on all ranks.
     *  @param memory empty: materials are elastic */
    bool
    find(MaterialMemory &memory) const;

    /** Gives the cells that have been at a tip or a notch in the static state
     *  the strength of these kernels.
     *  @param of_static_state kernels of the static state */
    void
    take_over(const std::vector<const CellKernel *> &of_static_state,
              MaterialMemory                        &memory) const;

  private:
    using Cell = Discretization::Cell;

    struct Crack
    {
      Cell                 cell;
      dealii::Tensor<1, 3> normal;
    };

    /** Whether the cracks of any material grow from tips. */
    bool
    is_needed() const;

    /** Cracks of own cells that were not found before. */
    std::vector<Crack>
    new_cracks(MaterialMemory &memory) const;

    /** Adds the cracks of ghost cells. */
    void
    exchange(std::vector<Crack> &cracks) const;

    /** Weakens the neighbours that the plane of the crack enters; returns
     *  whether any own cell has become weaker. */
    bool
    propagate(const Crack &crack, MaterialMemory &memory) const;

    /** Gives an own cell the strength of a tip; returns whether it has become
     *  weaker. */
    bool
    weaken(const Cell &cell, MaterialMemory &memory) const;

    /** Factor on the strength of a cell at a tip. */
    double
    strength_at(const Cell &cell) const;

    const Discretization           &discretization;
    std::vector<const CellKernel *> kernels;
    std::vector<bool>               follows_tips; // each material
    std::vector<bool>               is_shared;    // vertices of ghost cells
  };
} // namespace Voussoir

#endif
