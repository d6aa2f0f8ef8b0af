#include <voussoir/mesh/mesh_quality.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  void
  MeshQuality::take(const std::array<Point<3>, 8> &vertices)
  {
    double shortest = vertices[0].distance(vertices[1]), longest = shortest;
    double largest_cosine = -1.;
    for (unsigned int v = 0; v < 8; ++v)
      {
        // along direction d lies the vertex that differs in bit d
        std::array<Tensor<1, 3>, 3> edges;
        for (unsigned int d = 0; d < 3; ++d)
          {
            edges[d]            = vertices[v ^ (1U << d)] - vertices[v];
            const double length = edges[d].norm();
            shortest            = std::min(shortest, length);
            longest             = std::max(longest, length);
            edges[d] /= length;
          }
        // each edge that runs backwards turns the sign
        const double sign = (v ^ v >> 1 ^ v >> 2) & 1 ? -1. : 1.;
        scaled_jacobian =
          std::min(scaled_jacobian,
                   sign * (edges[0] * cross_product_3d(edges[1], edges[2])));
        for (unsigned int d = 0; d < 3; ++d)
          largest_cosine =
            std::max(largest_cosine, edges[d] * edges[(d + 1) % 3]);
      }
    smallest_angle =
      std::min(smallest_angle,
               std::acos(std::min(largest_cosine, 1.)) * 180. / numbers::PI);
    aspect_ratio = std::max(aspect_ratio, longest / shortest);
  }


  std::string
  MeshQuality::describe() const
  {
    std::ostringstream text;
    text.precision(3);
    text << "scaled Jacobian from " << scaled_jacobian << ", aspect ratio to "
         << aspect_ratio << ", angles from " << smallest_angle << " degrees";
    return text.str();
  }
} // namespace Voussoir
