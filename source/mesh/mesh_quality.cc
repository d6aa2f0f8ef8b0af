#include <voussoir/mesh/mesh_quality.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  void
  MeshQuality::take(const std::array<Point<3>, 8> &vertices)
  {
    // the unit vector along direction d from vertex v, or to it, joins the two
    // vertices that differ in bit d
    double shortest = std::numeric_limits<double>::max(), longest = 0.;
    std::array<std::array<Tensor<1, 3>, 8>, 3> along;
    for (unsigned int d = 0; d < 3; ++d)
      for (unsigned int v = 0; v < 8; ++v)
        if (const unsigned int end = v | (1U << d); end != v)
          {
            const Tensor<1, 3> edge   = vertices[end] - vertices[v];
            const double       length = edge.norm();
            shortest                  = std::min(shortest, length);
            longest                   = std::max(longest, length);
            along[d][v] = along[d][end] = edge / length;
          }
    double largest_cosine = -1.;
    for (unsigned int v = 0; v < 8; ++v)
      {
        scaled_jacobian =
          std::min(scaled_jacobian,
                   along[0][v] * cross_product_3d(along[1][v], along[2][v]));
        for (unsigned int d = 0; d < 3; ++d)
          {
            const unsigned int other = (d + 1) % 3;
            // one of the two vectors runs to the vertex
            const double sign = (v >> d ^ v >> other) & 1 ? -1. : 1.;
            largest_cosine =
              std::max(largest_cosine, sign * (along[d][v] * along[other][v]));
          }
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
