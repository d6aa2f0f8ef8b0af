#include <voussoir/fem/crack_bands.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Half the mean edges of a cell along its unit coordinates, of which a
    // crack takes a share.
    std::array<Tensor<1, 3>, 3>
    half_edges(const Grid::Cell &cell, const double share)
    {
      std::array<Tensor<1, 3>, 3> edges;
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int k = 0; k < 3; ++k)
          edges[k] += ((v >> k) & 1 ? 0.125 : -0.125) * share *
                      Tensor<1, 3>(cell->vertex(v));
      return edges;
    }
  } // namespace


  void
  CrackBands::set_lane(const unsigned int lane,
                       const Grid::Cell  &cell,
                       const double       share)
  {
    const auto   edges   = half_edges(cell, share);
    const double volume  = edges[0] * cross_product_3d(edges[1], edges[2]);
    double       longest = 0.;
    for (unsigned int k = 0; k < 3; ++k)
      {
        const Tensor<1, 3> &next    = edges[(k + 1) % 3],
                           &last    = edges[(k + 2) % 3];
        const Tensor<1, 3> gradient = cross_product_3d(next, last) / volume;
        for (unsigned int d = 0; d < 3; ++d)
          gradients[k][d][lane] = gradient[d];
        longest =
          std::max({longest, (next + last).norm(), (next - last).norm()});
      }
    widest[lane] = 2. * longest;
  }


  double
  CrackBands::along_edges(const Grid::Cell &cell, const double share)
  {
    // l of a normal along an edge is its length
    double longest = 0.;
    for (const Tensor<1, 3> &edge : half_edges(cell, share))
      longest = std::max(longest, 2. * edge.norm());
    return longest;
  }
} // namespace Voussoir
