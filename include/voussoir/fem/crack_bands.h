#ifndef voussoir_fem_crack_bands_h
#define voussoir_fem_crack_bands_h

#include <voussoir/fem/simd.h>
#include <voussoir/grid/grid.h>

namespace Voussoir
{
  /**
   * The shape of the cells of a batch for cracks: the width of the band
   * that a crack with the normal n takes (Oliver 1989),
   *   l(n) = 2 / sum_a |n . grad N_a|
   * over the corner functions at the centre. As these
   * gradients are (+-r_1 +-r_2 +-r_3)/8 with the gradients r of the unit
   * coordinates, the sum is that of |+-n.r_1 +-n.r_2 +-n.r_3| over four choices
   * of signs, divided by four. This is the width of the cell across n; of it a
   * crack takes the share Discretization::crack_share.
   */
  class CrackBands
  {
  public:
    CrackBands() = default;

    /** Takes the shape of a cell into one lane. */
    void
    set_lane(const unsigned int lane,
             const Grid::Cell  &cell,
             const double       share);

    /** l(n) [m]. */
    Lanes
    across(const dealii::Tensor<1, 3, Lanes> &normal) const
    {
      const Lanes a = normal * gradients[0], b = normal * gradients[1],
                  c = normal * gradients[2];
      return 8. / (std::abs(a + b + c) + std::abs(a + b - c) +
                   std::abs(a - b + c) + std::abs(a - b - c));
    }

    /** The largest of all normals: the longest diagonal of a face [m]. */
    Lanes widest = 1.;

    /** The band of a crack across the longest edge of a cell [m]. */
    static double
    along_edges(const Grid::Cell &cell, const double share);

  private:
    // of the unit coordinates, over the share [1/m]
    std::array<dealii::Tensor<1, 3, Lanes>, 3> gradients;
  };
} // namespace Voussoir

#endif
