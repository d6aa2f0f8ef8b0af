#include <voussoir/mesh/arch_dam_sweep.h>
#include <voussoir/mesh/grading.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Length over the dam's height in which the lines of the mesh turn from the
    // dam's normal into the river's direction.
    constexpr double relative_turning_length = 0.35;


    // On the downstream (-1) or the upstream (1) face, or between them.
    Point<2>
    face(const ArchDamSections::Line &line, const double side)
    {
      return line.centre +
             0.5 * side * line.thickness *
               Tensor<1, 2>({std::sin(line.angle), std::cos(line.angle)});
    }
  } // namespace


  ArchDamSweep::ArchDamSweep(const ArchDamCrossSection &section,
                             const ArchDamSections     &sections,
                             const double               height,
                             const double               rock_extent,
                             const unsigned int         n_thickness,
                             const double               cell_size,
                             const double               growth,
                             const double               largest_cell)
    : n_thickness(n_thickness)
    , turning_length(relative_turning_length * height)
    , full_length(rock_extent * height)
    , points(graded_points(full_length + turning_length,
                           cell_size,
                           growth,
                           largest_cell))
  {
    for (const auto &vertex : section.vertices)
      {
        lines.push_back(sections.line(vertex.s, vertex.z));
        upstream_end   = std::max(upstream_end, face(lines.back(), 1.)[1]);
        downstream_end = std::min(downstream_end, face(lines.back(), -1.)[1]);
      }
    upstream_end += full_length;
    downstream_end -= full_length;

    first_in_dam = points.size() - 1;
    n_layers     = 2 * first_in_dam + n_thickness;
  }


  std::vector<Point<2>>
  ArchDamSweep::operator()(const unsigned int vertex) const
  {
    const auto           &line = lines[vertex];
    std::vector<Point<2>> result(n_layers + 1);
    for (unsigned int j = 0; j <= n_thickness; ++j)
      result[first_in_dam + j] = face(line, 2. * j / n_thickness - 1.);
    for (const int side : {-1, 1})
      {
        const Point<2> start  = face(line, side);
        const double   end    = side < 0 ? downstream_end : upstream_end;
        const double   length = std::abs(end - start[1]) + turning_length -
                              path(line.angle, turning_length)[1];
        for (unsigned int j = 1; j < points.size(); ++j)
          {
            Point<2> &x =
              result[side < 0 ? first_in_dam - j : n_layers - first_in_dam + j];
            x = start + side * path(line.angle, points[j] * length);
            if (j + 1 == points.size())
              x[1] = end;
          }
      }
    return result;
  }


  unsigned int
  ArchDamSweep::layers_along(const double length) const
  {
    const double total  = points.size() - 1;
    unsigned int layers = 1;
    while (layers < total &&
           std::abs(points[layers + 1] * full_length - length) <
             std::abs(points[layers] * full_length - length))
      ++layers;
    return layers;
  }


  Tensor<1, 2>
  ArchDamSweep::path(const double angle, const double length) const
  {
    static const QGauss<1> quadrature(8);
    const double           turned = std::min(length, turning_length);
    Tensor<1, 2>           result({0., length - turned});
    for (unsigned int q = 0; q < quadrature.size(); ++q)
      {
        const double phi = angle * 0.5 *
                           (1. + std::cos(numbers::PI * quadrature.point(q)[0] *
                                          turned / turning_length));
        result += quadrature.weight(q) * turned *
                  Tensor<1, 2>({std::sin(phi), std::cos(phi)});
      }
    return result;
  }
} // namespace Voussoir
