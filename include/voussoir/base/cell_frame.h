#ifndef voussoir_base_cell_frame_h
#define voussoir_base_cell_frame_h

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

namespace Voussoir
{
  /** Centre and mean edges of a cell: the parallelepiped that approximates
   *  it. */
  struct CellFrame
  {
    dealii::Point<3>     centre;
    dealii::Tensor<2, 3> edges; // in the columns [m]

    /** Whether a point lies in the parallelepiped, enlarged about its centre by
     *  a factor. */
    bool
    holds(const dealii::Point<3> &point, const double factor) const
    {
      const dealii::Tensor<1, 3> place = invert(edges) * (point - centre);
      for (unsigned int d = 0; d < 3; ++d)
        if (!(std::abs(place[d]) <= 0.5 * factor))
          return false;
      return true;
    }
  };

  /** @param corner place of a corner, by its number in the cell [m] */
  template <typename Corner>
  CellFrame
  frame_of(const Corner &corner)
  {
    CellFrame frame;
    for (unsigned int v = 0; v < 8; ++v)
      {
        const dealii::Point<3> place = corner(v);
        frame.centre += 0.125 * place;
        for (unsigned int d = 0; d < 3; ++d)
          for (unsigned int k = 0; k < 3; ++k)
            frame.edges[k][d] += ((v >> d) & 1 ? 0.25 : -0.25) * place[k];
      }
    return frame;
  }
} // namespace Voussoir

#endif
