#include <voussoir/base/error.h>
#include <voussoir/mesh_sources/arch_dam_section.h>
#include <voussoir/mesh_sources/grading.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Over the height of a row: least distance of the surface of a reservoir
    // from the next row, and least and largest distance above the point where
    // its own row meets the contour.
    constexpr double surface_distance = 0.3;

    constexpr std::pair<double, double> surface_rise{0.2, 0.4};

    // Number of smoothing sweeps after which the vertices hardly move.
    constexpr unsigned int n_first_steps = 120;
  } // namespace


  ArchDamCrossSection::ArchDamCrossSection(const ArchDamSections &sections,
                                           const double           height,
                                           const unsigned int     n_blocks,
                                           const unsigned int columns_per_block,
                                           const double       row_height,
                                           const RockGrading &rock,
                                           const double       water_level,
                                           const std::array<Ledge, 2> &wanted)
    : ledges(wanted)
    , sections(sections)
    , height(height)
    , columns_per_block(columns_per_block)
  {
    place_columns(n_blocks * columns_per_block, rock);
    place_rows(row_height, rock);
    step_rows();
    follow_contour();
    on_surface.resize(vertices.size());
    if (water_level > 0.)
      lay_surface(water_level);
    on_ledge.resize(vertices.size());
    for (const int bank : {0, 1})
      if (ledges[bank].elevation > 0.)
        lay_ledge(ledges[bank], 2 * bank - 1);
    make_quads();
    line_contour();
    in_canyon.resize(vertices.size());
    for (const Quad &quad : quads)
      for (const unsigned int v : quad.vertices)
        in_canyon[v] = in_canyon[v] || quad.inside;
    smooth({{middle_line(0), middle_line(1)}},
           std::vector<bool>(vertices.size(), true),
           n_first_steps,
           vertices);
    check_shapes(vertices);
  }


  void
  ArchDamCrossSection::place_columns(const unsigned int n_dam_columns,
                                     const RockGrading &rock)
  {
    const double right = sections.right_end, left = sections.left_end;
    const double width = (left - right) / n_dam_columns;

    // Distances from the end of the crest into the rock.
    const auto beside = [&](const double end) {
      const double x      = sections.line(end, height).centre[0];
      const double extent = (end < 0 ? -1. : 1.) * rock.extent * height;
      const double length = std::abs(sections.arc_length_at(x + extent) - end);
      auto         distances = graded_points(length,
                                     rock.growth * width,
                                     rock.growth,
                                     2. * rock.largest_cell);
      for (double &distance : distances)
        distance *= length;
      return distances;
    };
    const std::vector<double> right_rock = beside(right),
                              left_rock  = beside(left);

    for (unsigned int i = right_rock.size() - 1; i > 0; --i)
      columns.push_back(right - right_rock[i]);
    first_dam_column = columns.size();
    for (unsigned int i = 0; i < n_dam_columns; ++i)
      columns.push_back(right + i * width);
    last_dam_column = columns.size();
    for (const double distance : left_rock)
      columns.push_back(left + distance);
    last_column = columns.size() - 1;

    for (const int bank : {0, 1})
      if (ledges[bank].elevation > 0.)
        place_foot(ledges[bank], 2 * bank - 1);

    for (const double s : columns)
      contour.push_back(sections.contour(s));
  }


  // Rows are so high that the contour crosses at most one of them per column.
  void
  ArchDamCrossSection::place_rows(const double wanted, const RockGrading &rock)
  {
    double least = wanted > 0. ?
                     0. :
                     columns[first_dam_column + 1] - columns[first_dam_column];
    for (unsigned int i = 1; i < columns.size(); ++i)
      least = std::max(least, std::abs(contour[i] - contour[i - 1]));
    double n_dam_rows = std::max(1., std::floor(height / least * (1. + 1e-9)));
    if (wanted > 0.)
      n_dam_rows = std::min(n_dam_rows, std::round(height / wanted));
    if (n_dam_rows < 3)
      throw UserError("In section \"Mesh/arch dam\" the canyon's banks are so "
                      "steep, or the \"Row height\" is so large, that the dam "
                      "would have fewer than three rows of blocks; choose a "
                      "smaller \"Cell size\" or \"Row height\", or gentler "
                      "banks.");
    const double row_height = height / n_dam_rows;

    const double depth = rock.extent * height;
    const auto   below = graded_points(depth,
                                     rock.growth * row_height,
                                     rock.growth,
                                     2. * rock.largest_cell);
    base_row           = below.size() - 1;
    for (unsigned int i = base_row; i > 0; --i)
      rows.push_back(-depth * below[i]);
    for (unsigned int i = 0; i < n_dam_rows; ++i)
      rows.push_back(i * row_height);
    rows.push_back(height);
  }


  std::pair<double, double>
  ArchDamCrossSection::height_and_length() const
  {
    return {0.5 * height / (rows.size() - 1 - base_row),
            0.5 * (sections.left_end - sections.right_end) /
              (last_dam_column - first_dam_column)};
  }


  std::vector<double>
  ArchDamCrossSection::elevations() const
  {
    std::vector<double> result{rows[base_row]};
    for (unsigned int k = base_row + 1; k < rows.size(); ++k)
      {
        result.push_back(0.5 * (rows[k - 1] + rows[k]));
        result.push_back(rows[k]);
      }
    return result;
  }


  // Finds the row next to the contour in each column.
  void
  ArchDamCrossSection::step_rows()
  {
    const double row_height = height / (rows.size() - 1 - base_row);
    const int    crest_row  = rows.size() - 1;
    for (int i = 0; i <= last_column; ++i)
      {
        // only the ends of the crest stand in the crest's row
        const int row = base_row + std::lround(contour[i] / row_height);
        contour_rows.push_back(contour[i] < height * (1. - 1e-9) ?
                                 std::min(row, crest_row - 1) :
                                 row);
      }
    // the contour leaves the row of a ledge at its foot
    for (const int bank : {0, 1})
      if (Ledge &ledge = ledges[bank]; ledge.foot_column >= 0)
        {
          const int side = 2 * bank - 1, foot = ledge.foot_column,
                    end = bank == 0 ? first_dam_column : last_dam_column;
          ledge.row     = std::min(contour_rows[foot],
                               crest_row - (std::abs(end - foot) > 1 ? 2 : 1));
          for (int i = first_dam_column; i <= last_dam_column; ++i)
            if (columns[i] * side > 0.)
              contour_rows[i] = (i - foot) * side > 0 ?
                                  std::max(contour_rows[i], ledge.row + 1) :
                                  std::min(contour_rows[i], ledge.row);
        }
  }


  // Makes the grid's vertices and moves those next to the contour onto it.
  void
  ArchDamCrossSection::follow_contour()
  {
    for (int i = 0; i <= last_column; ++i)
      {
        for (int k = 0; k < int(rows.size()); ++k)
          {
            on_contour.push_back(k == contour_rows[i]);
            vertices.push_back(
              {columns[i], on_contour.back() ? contour[i] : rows[k], i});
          }
      }
  }


  // The surface is the row of vertices, or of midpoints between two rows,
  // nearest to the level. The ends of the surface stay where the columns meet
  // the contour.
  void
  ArchDamCrossSection::lay_surface(const double water_level)
  {
    const int    n_rows     = rows.size();
    const double row_height = height / (n_rows - 1 - base_row);
    double       nearest    = std::numeric_limits<double>::max();
    for (int half_row = 2 * base_row + 1; half_row < 2 * n_rows - 1; ++half_row)
      {
        // the columns whose foot on the contour lies below this row
        const int row = half_row / 2, foot = (half_row - 1) / 2;
        int       first = first_dam_column, last = last_dam_column;
        while (first < last && contour_rows[first] > foot)
          ++first;
        while (last > first && contour_rows[last] > foot)
          --last;
        if (contour_rows[first] > foot)
          continue;

        double lower = rows[row], upper = rows[row];
        if (half_row % 2 == 1)
          {
            lower += surface_distance * row_height;
            upper = rows[row + 1] - surface_distance * row_height;
          }
        else if (row < n_rows - 1)
          {
            const double ends = std::max(contour[first - 1], contour[last + 1]);
            lower             = ends + surface_rise.first * row_height;
            upper = std::min(ends + surface_rise.second * row_height,
                             rows[row + 1] - surface_distance * row_height);
          }
        for (int i = first; i <= last; ++i)
          if (contour_rows[i] == foot)
            lower = std::max(lower, contour[i] + surface_distance * row_height);
        if (row == n_rows - 1) // the crest
          lower = upper = height;
        if (lower > upper)
          continue;
        const double z = std::min(upper, std::max(lower, water_level));
        if (std::abs(z - water_level) < nearest)
          {
            nearest         = std::abs(z - water_level);
            surface_level   = z;
            surface_row     = half_row;
            surface_columns = {first, last};
          }
      }
    if (surface_row % 2 == 0)
      for (int i = surface_columns.first - 1; i <= surface_columns.second + 1;
           ++i)
        {
          const unsigned int vertex = i * n_rows + surface_row / 2;
          on_surface[vertex]        = true;
          if (!on_contour[vertex])
            vertices[vertex].z = surface_level;
        }
  }


  void
  ArchDamCrossSection::make_quads()
  {
    const unsigned int n_rows = rows.size();
    for (int i = 0; i < last_column; ++i)
      {
        const bool at_dam = i >= first_dam_column && i < last_dam_column;
        const int  left = contour_rows[i], right = contour_rows[i + 1];
        for (int k = 0; k + 1 < int(n_rows); ++k)
          {
            const unsigned int a = i * n_rows + k, b = a + n_rows, c = b + 1,
                               d = a + 1;
            if (k >= std::max(left, right))
              subdivide({a, b, c, d}, i, k, at_dam);
            else if (k < std::min(left, right))
              subdivide({a, b, c, d}, i, k, false);
            else if (left < right)
              {
                subdivide({a, b, c}, i, k, false);
                subdivide({a, c, d}, i, k, at_dam);
              }
            else
              {
                subdivide({a, b, d}, i, k, false);
                subdivide({b, c, d}, i, k, at_dam);
              }
          }
      }
  }


  // Divides a triangle or quadrilateral into quadrilaterals around its centre.
  void
  ArchDamCrossSection::subdivide(const std::vector<unsigned int> &corners,
                                 const unsigned int               column,
                                 const unsigned int               row,
                                 const bool                       inside)
  {
    const unsigned int        n = corners.size();
    std::vector<unsigned int> around;
    Vertex                    centre{0., 0., -1};
    for (unsigned int i = 0; i < n; ++i)
      {
        around.push_back(middle(corners[i], corners[(i + 1) % n]));
        centre.s += vertices[around[i]].s / n;
        centre.z += vertices[around[i]].z / n;
      }
    on_surface.push_back(n == 4 && inside && 2 * int(row) + 1 == surface_row);
    if (on_surface.back())
      centre.z = surface_level;
    vertices.push_back(centre);
    on_contour.push_back(false);
    on_ledge.push_back(false);

    const double cell_width    = 0.5 * (columns[column + 1] - columns[column]),
                 cell_height   = 0.5 * (rows[row + 1] - rows[row]);
    const auto is_further_down = [&](const unsigned int u,
                                     const unsigned int v) {
      return vertices[u].s / cell_width + vertices[u].z / cell_height <
             vertices[v].s / cell_width + vertices[v].z / cell_height;
    };
    for (unsigned int i = 0; i < n; ++i)
      {
        std::array<unsigned int, 4> quad{
          {corners[i],
           around[i],
           static_cast<unsigned int>(vertices.size() - 1),
           around[(i + n - 1) % n]}};
        // All begin at the lower right-bank corner, so that neighbours have the
        // same orientation.
        std::rotate(quad.begin(),
                    std::min_element(quad.begin(), quad.end(), is_further_down),
                    quad.end());
        // a cell in the canyon has one or two lower corners
        const int half_row = 2 * row + (i < n - 2 ? 0 : 1);
        // quadrilaterals beside the contour are as wide as high
        const double side = std::sqrt(cell_width * cell_height);
        quads.push_back({quad,
                         column,
                         half_row,
                         inside,
                         n == 3 ? side : cell_width,
                         n == 3 ? side : cell_height});
      }
  }


  unsigned int
  ArchDamCrossSection::middle(const unsigned int a, const unsigned int b)
  {
    const auto [entry, is_new] =
      middles.insert({std::minmax(a, b), vertices.size()});
    if (is_new)
      {
        const Vertex &u = vertices[a], &v = vertices[b];
        const bool    along_column = u.column == v.column;
        Vertex        vertex{0.5 * (u.s + v.s),
                      0.5 * (u.z + v.z),
                      along_column ? u.column : -1};
        on_contour.push_back(!along_column && on_contour[a] && on_contour[b]);
        if (on_contour.back())
          vertex.z = sections.contour(vertex.s);
        on_surface.push_back(
          (on_surface[a] && on_surface[b]) ||
          (along_column &&
           2 * int(std::min(a, b) % rows.size()) + 1 == surface_row &&
           u.column >= surface_columns.first &&
           u.column <= surface_columns.second));
        if (on_surface.back())
          vertex.z = surface_level;
        on_ledge.push_back(on_ledge[a] && on_ledge[b]);
        vertices.push_back(vertex);
      }
    return entry->second;
  }
} // namespace Voussoir
