#include <voussoir/base/error.h>
#include <voussoir/mesh_sources/arch_dam_sweep.h>
#include <voussoir/mesh_sources/grading.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Length over the dam's height in which the lines of the mesh turn from the
    // dam's normal into the river's direction.
    constexpr double relative_turning_length_of_sweep = 0.35;


    // Share of a cell by which the foot of a ledge moves in one step.
    constexpr double relative_step = 0.1;


    using LedgeLines = std::array<ArchDamCrossSection::LedgeLine, 2>;


    // Linear interpolation between two sets of lines.
    LedgeLines
    between(const LedgeLines &from, const LedgeLines &to, const double part)
    {
      LedgeLines result;
      for (const unsigned int bank : {0, 1})
        result[bank] = {(1. - part) * from[bank].foot + part * to[bank].foot,
                        [&, bank, part](const double s) {
                          return (1. - part) * from[bank].level(s) +
                                 part * to[bank].level(s);
                        }};
      return result;
    }


    // The point on the downstream (-1) or the upstream (1) face, or between
    // them.
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
                             const RockGrading         &rock,
                             const unsigned int         n_thickness,
                             const double               cell_size)
    : sections(sections)
    , n_thickness(n_thickness)
    , turning_length(relative_turning_length_of_sweep * height)
    , full_length(rock.extent * height)
    , points(graded_points(full_length + turning_length,
                           cell_size,
                           rock.growth,
                           rock.largest_cell))
    , ledges(section.ledges)
    , vertices(section.vertices)
  {
    for (const auto &vertex : vertices)
      {
        const auto line = sections.line(vertex.s, vertex.z);
        upstream_end    = std::max(upstream_end, face(line, 1.)[1]);
        downstream_end  = std::min(downstream_end, face(line, -1.)[1]);
      }
    upstream_end += full_length;
    downstream_end -= full_length;

    first_in_dam = points.size() - 1;
    n_layers     = 2 * first_in_dam + n_thickness;
    if (ledges[0].dips() || ledges[1].dips())
      lay_ledges(section, relative_step * cell_size);
  }


  std::vector<Point<3>>
  ArchDamSweep::operator()(const unsigned int vertex) const
  {
    std::vector<Point<3>> result;
    for (unsigned int layer = 0; layer <= n_layers; ++layer)
      {
        const auto &at =
          moved.empty() ?
            vertices[vertex] :
            moved[std::clamp(layer,
                             first_moved,
                             first_moved + unsigned(moved.size()) - 1) -
                  first_moved][vertex];
        result.emplace_back(at.s, layer, at.z);
      }
    return result;
  }


  std::vector<Point<3>>
  ArchDamSweep::positions(const std::vector<Point<3>> &coordinates) const
  {
    std::vector<Point<3>> result;
    result.reserve(coordinates.size());
    ArchDamSections::Line line;
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      {
        const Point<3> &at = coordinates[i];
        if (i == 0 || at[0] != coordinates[i - 1][0] ||
            at[2] != coordinates[i - 1][2])
          line = sections.line(at[0], at[2]);
        const Point<2> x = point(line, at[1]);
        result.emplace_back(x[0], x[1], at[2]);
      }
    return result;
  }


  double
  ArchDamSweep::part_of_way(const double layers) const
  {
    const unsigned int below = layers;
    return layers > below ?
             points[below] +
               (layers - below) * (points[below + 1] - points[below]) :
             points[below];
  }


  Point<2>
  ArchDamSweep::point(const ArchDamSections::Line &line,
                      const double                 layer) const
  {
    if (layer >= first_in_dam && layer <= first_in_dam + n_thickness)
      return face(line, 2. * (layer - first_in_dam) / n_thickness - 1.);
    const int    side = layer < first_in_dam ? -1 : 1;
    const double beside =
      side < 0 ? first_in_dam - layer : layer - first_in_dam - n_thickness;
    Point<2> x =
      face(line, side) +
      side * path(line.angle, part_of_way(beside) * length_beside(line, side));
    if (beside == points.size() - 1.)
      x[1] = side < 0 ? downstream_end : upstream_end;
    return x;
  }


  double
  ArchDamSweep::length_beside(const ArchDamSections::Line &line,
                              const int                    side) const
  {
    const double end = side < 0 ? downstream_end : upstream_end;
    return std::abs(end - face(line, side)[1]) + turning_length -
           path(line.angle, turning_length)[1];
  }


  // Step by step from the middle of the dam, so that no cell is inverted.
  // Beyond the ledges the section stays the same as at their ends.
  void
  ArchDamSweep::lay_ledges(const ArchDamCrossSection &section,
                           const double               step)
  {
    std::array<unsigned int, 2> begin{{first_in_dam, first_in_dam}};
    for (const unsigned int bank : {0, 1})
      if (ledges[bank].dips())
        begin[bank] -= layers_along(ledges[bank].length);
    const unsigned int middle = first_in_dam + n_thickness / 2,
                       end    = first_in_dam + n_thickness;
    first_moved               = std::min(begin[0], begin[1]);
    moved.resize(end + 1 - first_moved);

    for (const int direction : {-1, 1})
      {
        LedgeLines lines{{section.middle_line(0), section.middle_line(1)}};
        Vertices   current = vertices;
        for (unsigned int layer = middle; layer >= first_moved && layer <= end;
             layer += direction)
          {
            LedgeLines next = lines;
            double     way  = 0.;
            for (const unsigned int bank : {0, 1})
              if (ledges[bank].dips() && layer >= begin[bank])
                {
                  next[bank] =
                    ledge_line(ledges[bank], layer, lines[bank].foot);
                  way =
                    std::max(way, std::abs(next[bank].foot - lines[bank].foot));
                }
            const unsigned int n_steps = 1 + std::floor(way / step);
            for (unsigned int i = 1; i <= n_steps; ++i)
              section.follow(between(lines, next, double(i) / n_steps),
                             layer >= first_in_dam,
                             current);
            section.check_shapes(current);
            moved[layer - first_moved] = current;
            lines                      = next;
          }
      }
  }


  const ArchDamCrossSection::Ledge &
  ArchDamSweep::ledge_at(const double s) const
  {
    return ledges[s < 0. ? 0 : 1];
  }


  double
  ArchDamSweep::level(const ArchDamCrossSection::Ledge &ledge,
                      const double                      layer,
                      const double                      s) const
  {
    return ledge.level(point(sections.line(s, 0.), layer));
  }


  Point<3>
  ArchDamSweep::onto_ledge(const Point<3> &at) const
  {
    return {at[0], at[1], level(ledge_at(at[0]), at[1], at[0])};
  }


  Point<3>
  ArchDamSweep::onto_foot(const Point<3> &at) const
  {
    const double s = ledge_line(ledge_at(at[0]), at[1], at[0]).foot;
    return {s, at[1], sections.contour(s)};
  }


  // The foot is where the contour meets the plane: Newton's method from a place
  // nearby.
  ArchDamCrossSection::LedgeLine
  ArchDamSweep::ledge_line(const ArchDamCrossSection::Ledge &ledge,
                           const double                      layer,
                           const double                      near) const
  {
    constexpr double probe = 0.1, accuracy = 1e-8, largest_step = 10.; // [m]
    constexpr double least_slope = 0.1;

    const auto above = [&](const double s) {
      return sections.contour(s) - level(ledge, layer, s);
    };
    double       foot = near;
    const double side = near < 0. ? -1. : 1.;
    for (unsigned int i = 0; i < 100; ++i)
      {
        const double slope =
          (above(foot + probe) - above(foot - probe)) / (2. * probe);
        const double height = above(foot);
        if (slope * side < least_slope)
          break;
        if (std::abs(height) < accuracy)
          return {foot, [this, &ledge, layer](const double s) {
                    return level(ledge, layer, s);
                  }};
        foot -= std::clamp(height / slope, -largest_step, largest_step);
      }
    throw UserError(
      "The bank is too flat for the \"Dip\" in section \"" + ledge.place +
      "\": the base plane of the wedge does not meet its surface everywhere; "
      "choose a smaller one or another \"Elevation\".");
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


  double
  ArchDamSweep::length_downstream(const unsigned int layers,
                                  const double       s,
                                  const double       z) const
  {
    return part_of_way(layers) * length_beside(sections.line(s, z), -1);
  }


  Tensor<1, 2>
  ArchDamSweep::path(const double angle, const double length) const
  {
    const double turned = std::min(length, turning_length);
    Tensor<1, 2> result({0., length - turned});
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
