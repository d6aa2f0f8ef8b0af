#include <voussoir/base/error.h>
#include <voussoir/mesh/abutment_wedge.h>
#include <voussoir/mesh/interface_surface.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int none = numbers::invalid_unsigned_int;

    // How many rows away the rock still follows the straightened bottom.
    constexpr double relative_reach = 4.;

    int
    row(const ArchDamCrossSection::Quad &quad)
    {
      return quad.half_row / 2;
    }


    // s of each column of the grid, by one of its vertices
    std::vector<double>
    column_positions(const ArchDamCrossSection &section)
    {
      std::vector<double> s(section.last_column + 1);
      for (auto vertex = section.vertices.rbegin();
           vertex != section.vertices.rend();
           ++vertex)
        if (vertex->column >= 0)
          s[vertex->column] = vertex->s;
      return s;
    }
    // By column, the vertex where it meets the canyon's contour.
    std::map<int, unsigned int>
    feet_of_columns(const ArchDamCrossSection &section)
    {
      std::set<unsigned int> inside;
      for (const auto &quad : section.quads)
        if (quad.inside)
          inside.insert(quad.vertices.begin(), quad.vertices.end());
      std::map<int, unsigned int> feet;
      for (const auto &quad : section.quads)
        for (const unsigned int v : quad.vertices)
          if (!quad.inside && inside.count(v) > 0 &&
              section.vertices[v].column >= 0)
            feet[section.vertices[v].column] = v;
      return feet;
    }
  } // namespace


  void
  AbutmentWedgeParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Elevation",
                      elevation,
                      "Of the wedge's level bottom, rounded to where a row of "
                      "cells meets the bank [m above the base]; 0: no wedge.",
                      Patterns::Double(0.));
    prm.add_parameter("Width",
                      width,
                      "Into the bank, from where the bottom meets the canyon, "
                      "rounded to columns of cells [m].",
                      Patterns::Double(1e-3));
    prm.add_parameter("Length",
                      length,
                      "Downstream of the dam, rounded to cells [m].",
                      Patterns::Double(1e-3));
    prm.add_parameter("Cut",
                      cut,
                      "Length of the gully at the wedge's downstream end, "
                      "rounded to cells [m].",
                      Patterns::Double(1e-3));
  }


  AbutmentWedge::AbutmentWedge(const AbutmentWedgeParameters &parameters,
                               const int                      bank,
                               const Layers                  &layers,
                               ArchDamCrossSection           &section,
                               const std::string             &place)
    : bank(bank)
    , n_layers(layers.n)
    , end(layers.dam_end)
  {
    const unsigned int wedge = layers.along(parameters.length),
                       all   = layers.along(parameters.length + parameters.cut);
    if (all >= layers.dam_begin)
      throw UserError("\"Length\" and \"Cut\" in section \"" + place +
                      "\" reach the downstream end of the rock; shorten the "
                      "wedge or increase \"Rock extent\".");
    begin     = layers.dam_begin - wedge;
    cut_begin = layers.dam_begin - std::max(all, wedge + 1);
    find_row(parameters, section, place);
    straighten(section);
  }


  void
  AbutmentWedge::find_row(const AbutmentWedgeParameters &parameters,
                          const ArchDamCrossSection     &section,
                          const std::string             &place)
  {
    const std::vector<double> s = column_positions(section);

    // The foot nearest to the elevation from which a row goes into the rock.
    double nearest = std::numeric_limits<double>::max();
    bottom_row     = -1;
    for (const auto &[column, foot] : feet_of_columns(section))
      {
        const double z = section.vertices[foot].z;
        if (s[column] * bank <= 0. ||
            std::abs(z - parameters.elevation) >= nearest)
          continue;
        int upper = -1, lower = std::numeric_limits<int>::max();
        for (const auto &quad : section.quads)
          if (!quad.inside && int(quad.column) == column - (bank < 0) &&
              std::count(quad.vertices.begin(), quad.vertices.end(), foot) > 0)
            {
              upper = std::max(upper, row(quad));
              lower = std::min(lower, row(quad));
            }
        if (upper > lower && column != section.first_dam_column &&
            column != section.last_dam_column)
          {
            nearest     = std::abs(z - parameters.elevation);
            foot_column = column;
            bottom_row  = upper;
            level       = z;
          }
      }
    if (bottom_row < 0)
      throw UserError("\"Elevation\" in section \"" + place +
                      "\" finds no row of cells that meets the bank there; "
                      "choose another elevation.");

    side_column           = foot_column + bank;
    const auto too_narrow = [&](const int column) {
      return std::abs(0.5 * (s[column] + s[column + bank]) - s[foot_column]) <
             parameters.width;
    };
    while (side_column > 1 && side_column + 1 < section.last_column &&
           too_narrow(side_column))
      side_column += bank;
  }


  // The bottom becomes level and the side upright. The rock above and below
  // follows, the less the farther away it is; contour and ground stay.
  void
  AbutmentWedge::straighten(ArchDamCrossSection &section) const
  {
    const std::vector<double> s   = column_positions(section);
    double                    top = 0.;
    for (const auto &vertex : section.vertices)
      top = std::max(top, vertex.z);
    std::set<unsigned int> above, below, beside, fixed;
    double                 reach = 0.;
    for (const auto &quad : section.quads)
      {
        if (quad.inside)
          fixed.insert(quad.vertices.begin(), quad.vertices.end());
        else if (is_in_columns(quad))
          for (const unsigned int v : quad.vertices)
            {
              if (row(quad) == bottom_row)
                above.insert(v);
              if (row(quad) == bottom_row - 1)
                below.insert(v);
              if (section.vertices[v].column == side_column &&
                  row(quad) >= bottom_row)
                beside.insert(v);
              reach = std::max(reach, 2. * relative_reach * quad.height);
            }
      }
    for (unsigned int v = 0; v < section.vertices.size(); ++v)
      if (section.vertices[v].z > top * (1. - 1e-9))
        fixed.insert(v);
    std::map<double, double> shift_at; // by s
    for (const unsigned int v : above)
      if (below.count(v) > 0)
        shift_at[section.vertices[v].s] = level - section.vertices[v].z;

    const auto shift = [&](const double position) {
      const auto after = shift_at.lower_bound(position);
      if (after == shift_at.begin() || after == shift_at.end())
        {
          // fades out beside the wedge
          const auto &end =
            after == shift_at.end() ? *shift_at.rbegin() : *after;
          const double distance = std::abs(end.first - position);
          return end.second * std::max(0., 1. - distance / reach);
        }
      const auto  &a = *std::prev(after), &b = *after;
      const double t = (position - a.first) / (b.first - a.first);
      return (1. - t) * a.second + t * b.second;
    };
    for (unsigned int v = 0; v < section.vertices.size(); ++v)
      {
        auto &vertex = section.vertices[v];
        if (fixed.count(v) > 0 || vertex.s * bank <= 0.)
          continue;
        const double by = shift(vertex.s);
        if (above.count(v) > 0 && below.count(v) > 0)
          vertex.z = level;
        else
          vertex.z +=
            by * std::max(0., 1. - std::abs(vertex.z - (level - by)) / reach);
        if (beside.count(v) > 0)
          vertex.s = s[side_column];
      }
  }


  bool
  AbutmentWedge::is_in_columns(const ArchDamCrossSection::Quad &quad) const
  {
    return quad.column >= unsigned(std::min(foot_column, side_column)) &&
           quad.column < unsigned(std::max(foot_column, side_column));
  }


  bool
  AbutmentWedge::contains(const ArchDamCrossSection::Quad &quad,
                          const unsigned int               layer) const
  {
    return !quad.inside && is_in_columns(quad) && row(quad) >= bottom_row &&
           layer >= begin && layer < end;
  }


  bool
  AbutmentWedge::is_cut(const ArchDamCrossSection::Quad &quad,
                        const unsigned int               layer) const
  {
    return !quad.inside && is_in_columns(quad) && row(quad) >= bottom_row &&
           layer >= cut_begin && layer < begin;
  }


  void
  AbutmentWedge::add_sets(const ArchDamCrossSection       &section,
                          const std::vector<unsigned int> &cell_number,
                          CoarseMesh                      &mesh) const
  {
    const std::string name = bank < 0 ? "right wedge" : "left wedge";
    std::vector<std::pair<unsigned int, unsigned int>> place(mesh.cells.size());
    std::vector<bool> is_rock(mesh.cells.size()), is_wedge(mesh.cells.size());
    for (unsigned int i = 0; i < cell_number.size(); ++i)
      if (const unsigned int cell = cell_number[i]; cell != none)
        {
          const auto &quad = section.quads[i / n_layers];
          place[cell]      = {i / n_layers, i % n_layers};
          is_rock[cell]    = !quad.inside;
          is_wedge[cell]   = contains(quad, i % n_layers);
          if (is_wedge[cell])
            mesh.cell_sets[name].push_back(cell);
        }

    std::set<std::pair<unsigned int, unsigned int>> named;
    for (const auto &set : mesh.face_sets)
      for (const CoarseMesh::Face &face : set.second)
        named.emplace(face.cell, face.face);
    const FaceNeighbours neighbours = find_face_neighbours(mesh);
    for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
      for (unsigned int face = 0; face < 6; ++face)
        {
          const unsigned int other = neighbours[cell][face].cell;
          if (other == none)
            {
              if (named.count({cell, face}) == 0)
                mesh.face_sets["ground"].push_back({cell, face});
            }
          else if (is_wedge[cell] && !is_wedge[other] && is_rock[other])
            {
              const auto &quad = section.quads[place[other].first];
              mesh
                .face_sets[name + (place[other].second >= end ? " back" :
                                   row(quad) < bottom_row     ? " bottom" :
                                                                " side")]
                .push_back({cell, face});
            }
        }
  }
} // namespace Voussoir
