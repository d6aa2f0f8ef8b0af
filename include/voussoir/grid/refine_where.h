#ifndef voussoir_grid_refine_where_h
#define voussoir_grid_refine_where_h

#include <voussoir/base/cell_frame.h>

#include <deal.II/numerics/rtree.h>

#include <vector>

namespace Voussoir
{
  /** Cells of another run, and the ring of cells around each of them. */
  class CellsAndRing
  {
  public:
    explicit CellsAndRing(const std::vector<CellFrame> &cells);

    /** Whether the centre of a cell lies in any of the cells or in its ring, or
     *  the centre of one of the cells lies in this cell. */
    bool
    reach(const CellFrame &cell) const;

  private:
    std::vector<CellFrame> cells;

    /** Boxes around the cells with their rings, with their numbers. */
    dealii::RTree<std::pair<dealii::BoundingBox<3>, unsigned int>> boxes;
  };
} // namespace Voussoir

#endif
