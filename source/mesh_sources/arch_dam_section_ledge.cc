#include <voussoir/base/error.h>
#include <voussoir/mesh_sources/arch_dam_section.h>

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Least rise of a bank above a ledge from its first column on, over the
    // height of a row.
    constexpr double ledge_rise = 0.3;

    // Limits of the change of width of columns that are moved to the foot of a
    // ledge.
    constexpr double column_stretch = 1.8;

    // Distance of the foot of an inclined ledge from a joint, in blocks of
    // several columns.
    constexpr double columns_to_joint = 3.;

    // Number of smoothing steps after a ledge is moved.
    constexpr unsigned int n_later_steps = 20;

    // Beside a ledge: least sine of the angle between edges of a quadrilateral,
    // and least length of an edge over the size of a cell.
    constexpr double least_sine = 0.2, least_edge = 0.1;
  } // namespace


  // A dipping ledge meets each section of the dam at another place, which
  // joints must not follow: the foot of the ledge is in a column well between
  // joints.
  void
  ArchDamCrossSection::place_foot(Ledge &ledge, const int bank)
  {
    const std::string entry =
      "\"Elevation\" in section \"" + ledge.place + "\" ";
    if (ledge.elevation >= height)
      throw UserError(entry + "is not below the dam's crest; choose a lower "
                              "one.");
    const int    n     = last_dam_column - first_dam_column;
    const double end   = bank < 0 ? sections.right_end : sections.left_end;
    const double width = (sections.left_end - sections.right_end) / n;
    if (ledge.dips() && columns_per_block == 1)
      {
        std::ostringstream text;
        text << "The wedge of section \"" << ledge.place
             << "\" has a \"Dip\", for which the dam needs more than one cell "
                "of \"Cell size\" between two joints; let it be at most "
             << std::floor(width / 3.) << " m.";
        throw UserError(text.str());
      }

    std::uintmax_t n_steps = 200;
    const double   foot =
      boost::math::tools::toms748_solve(
        [&](const double part) {
          return sections.contour(part * end) - ledge.elevation;
        },
        0.,
        1.,
        -ledge.elevation,
        height - ledge.elevation,
        boost::math::tools::eps_tolerance<double>(),
        n_steps)
        .first *
      end;

    // change of width of the columns on both sides of a column
    const auto stretch = [&](const int i) {
      const double towards = foot / columns[i],
                   beyond  = (end - foot) / (end - columns[i]);
      return std::max({towards, beyond, 1. / towards, 1. / beyond});
    };
    double least = column_stretch;
    for (int i = first_dam_column + 1; i < last_dam_column; ++i)
      {
        const int in_block = (i - first_dam_column) % columns_per_block;
        const int to_joint = std::min(in_block, columns_per_block - in_block);
        if (columns[i] * bank > 0. &&
            (!ledge.dips() ||
             to_joint >= std::min(columns_per_block / 3., columns_to_joint)) &&
            stretch(i) < least)
          {
            least             = stretch(i);
            ledge.foot_column = i;
          }
      }
    if (ledge.foot_column < 0)
      throw UserError(entry + "is so near the crest or the base that cells "
                              "there would be narrow; choose another elevation "
                              "or a smaller \"Cell size\".");
    const double old     = columns[ledge.foot_column];
    const double towards = foot / old, beyond = (end - foot) / (end - old);
    for (int i = first_dam_column; i <= last_dam_column; ++i)
      if (columns[i] * bank > 0.)
        columns[i] = std::abs(columns[i]) <= std::abs(old) ?
                       columns[i] * towards :
                       end - (end - columns[i]) * beyond;
    columns[ledge.foot_column] = foot;
    ledge.foot                 = sections.line(foot, ledge.elevation).centre;
  }


  // The ledge reaches from its foot to the column nearest to the width. The
  // rows above and below are moved.
  void
  ArchDamCrossSection::lay_ledge(Ledge &ledge, const int bank)
  {
    const int    n_rows     = rows.size();
    const double row_height = height / (n_rows - 1 - base_row);

    // neither the crest's end, where the layer along the contour reaches the
    // ground surface, nor the last column but one
    const int foot      = ledge.foot_column;
    ledge.side_column   = foot + bank;
    const auto too_near = [&](const int column) {
      return column == first_dam_column || column == last_dam_column ||
             std::abs(0.5 * (columns[column] + columns[column + bank]) -
                      columns[foot]) < ledge.width;
    };
    while (ledge.side_column > 1 && ledge.side_column + 1 < last_column &&
           too_near(ledge.side_column))
      ledge.side_column += bank;

    const LedgeLine line = middle_line(bank < 0 ? 0 : 1);
    const double    side = columns[ledge.side_column],
                 end     = columns[bank < 0 ? 0 : last_column];
    ledge.laid           = std::abs(side - columns[foot]);
    for (int i = foot; i >= 0 && i <= last_column; i += bank)
      {
        const bool   on_it  = (ledge.side_column - i) * bank >= 0;
        const double level  = line.level(on_it ? columns[i] : side),
                     bottom = rows.front();
        if (on_it && i != foot && contour[i] - level < ledge_rise * row_height)
          refuse_daylight(ledge, columns[i] - columns[foot]);
        const double rise = (level - rows[ledge.row]) *
                            (on_it ? 1. : (end - columns[i]) / (end - side));
        for (int k = 1; k < contour_rows[i]; ++k)
          {
            double &z = vertices[i * n_rows + k].z;
            z += rise * (k <= ledge.row ?
                           (z - bottom) / (rows[ledge.row] - bottom) :
                           (contour[i] - z) / (contour[i] - rows[ledge.row]));
          }
        if (on_it)
          {
            on_ledge[i * n_rows + ledge.row]   = true;
            vertices[i * n_rows + ledge.row].z = level;
          }
      }
  }


  void
  ArchDamCrossSection::refuse_daylight(const Ledge &ledge,
                                       const double distance) const
  {
    std::ostringstream text;
    text.precision(3);
    text << "The base plane of the wedge of section \"" << ledge.place
         << "\" comes out of the ground, or close to it, " << std::abs(distance)
         << " m from its foot; choose another "
         << "\"Elevation\" or a smaller \"Dip\", \"Width\" or \"Cell size\".";
    throw UserError(text.str());
  }


  ArchDamCrossSection::LedgeLine
  ArchDamCrossSection::middle_line(const unsigned int bank) const
  {
    const Ledge &ledge = ledges[bank];
    if (ledge.foot_column < 0)
      return {0., {}};
    return {columns[ledge.foot_column], [&](const double s) {
              return ledge.dips() ? ledge.level(sections.line(s, 0.).centre) :
                                    ledge.elevation;
            }};
  }


  void
  ArchDamCrossSection::follow(const std::array<LedgeLine, 2> &lines,
                              const bool                      in_dam,
                              std::vector<Vertex>            &moved) const
  {
    for (unsigned int v = 0; v < moved.size(); ++v)
      if (on_ledge[v])
        {
          const LedgeLine &line = lines[moved[v].s < 0. ? 0 : 1];
          if (on_contour[v])
            moved[v].s = line.foot;
          moved[v].z = line.level(moved[v].s);
        }
    smooth(lines,
           in_dam ? in_canyon : std::vector<bool>(moved.size()),
           n_later_steps,
           moved);
  }


  void
  ArchDamCrossSection::check_shapes(const std::vector<Vertex> &moved) const
  {
    for (const Quad &quad : quads)
      for (unsigned int i = 0; i < 4; ++i)
        {
          const auto edge = [&](const unsigned int j) {
            const Vertex &from = moved[quad.vertices[i]],
                         &to   = moved[quad.vertices[j % 4]];
            return Tensor<1, 2>({to.s - from.s, to.z - from.z});
          };
          const Tensor<1, 2> a = edge(i + 1), b = edge(i + 3);
          const bool         is_flat =
            a[0] * b[1] - a[1] * b[0] < least_sine * a.norm() * b.norm() ||
            a.norm() < least_edge * std::min(quad.width, quad.height);
          const Ledge &ledge = ledges[moved[quad.vertices[i]].s < 0. ? 0 : 1];
          if (ledge.foot_column >= 0 && is_flat)
            throw UserError("The base plane of the wedge of section \"" +
                            ledge.place +
                            "\" makes cells beside it nearly flat; choose "
                            "another \"Elevation\", a smaller \"Dip\" or "
                            "\"Cell size\" or a shorter wedge.");
        }
  }
} // namespace Voussoir
