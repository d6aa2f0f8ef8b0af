#include <voussoir/base/error.h>
#include <voussoir/mesh/interface_surface.h>
#include <voussoir/mesh_sources/abutment_wedge.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    int
    row(const ArchDamCrossSection::Quad &quad)
    {
      return quad.half_row / 2;
    }
  } // namespace


  void
  AbutmentWedgeParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Elevation",
      elevation,
      "Elevation at which the base plane of the wedge meets the bank on the "
      "dam's middle surface; columns of cells, and so the joints of that "
      "bank, are moved to this place [m above the base]. 0: no wedge.",
      Patterns::Double(0.));
    prm.add_parameter(
      "Dip",
      dip,
      "Dip of the base plane; cells beside a steep plane become flat "
      "[degrees].",
      Patterns::Double(0., 45.));
    prm.add_parameter(
      "Dip direction",
      direction,
      "Dip direction of the base plane: 0 across the river into the canyon, "
      "90 downstream, -90 upstream [degrees].",
      Patterns::Double(-90., 90.));
    prm.add_parameter(
      "Width",
      width,
      "Extent into the bank, from where the base plane meets the canyon, "
      "rounded to columns of cells [m].",
      Patterns::Double(1e-3));
    prm.add_parameter("Length",
                      length,
                      "Extent downstream of the dam, rounded to cells [m].",
                      Patterns::Double(1e-3));
    prm.add_parameter("Cut",
                      cut,
                      "Length of the cut, where rock is removed, downstream "
                      "of the wedge, rounded to cells [m].",
                      Patterns::Double(1e-3));
  }


  ArchDamCrossSection::Ledge
  AbutmentWedgeParameters::ledge(const unsigned int bank) const
  {
    const double radians = numbers::PI / 180.;

    ArchDamCrossSection::Ledge result;
    result.elevation = elevation;
    result.width     = width;
    result.length    = length;
    result.slope =
      std::tan(dip * radians) *
      Tensor<1, 2>({(bank == 0 ? -1. : 1.) * std::cos(direction * radians),
                    std::sin(direction * radians)});
    return result;
  }


  AbutmentWedge::AbutmentWedge(const AbutmentWedgeParameters &parameters,
                               const unsigned int             bank,
                               const Layers                  &layers,
                               const ArchDamCrossSection     &section,
                               const std::string             &place)
    : bank(bank)
    , n_layers(layers.n)
    , dam_begin(layers.dam_begin)
    , end(layers.dam_end)
    , ledge(section.ledges[bank])
  {
    const unsigned int wedge = layers.along(parameters.length),
                       all   = layers.along(parameters.length + parameters.cut);
    if (all >= layers.dam_begin)
      throw UserError("\"Length\" and \"Cut\" in section \"" + place +
                      "\" reach the downstream end of the rock; shorten the "
                      "wedge or increase \"Rock extent\".");
    begin     = layers.dam_begin - wedge;
    cut_begin = layers.dam_begin - std::max(all, wedge + 1);
  }


  std::string
  AbutmentWedge::name() const
  {
    return bank == 0 ? "right wedge" : "left wedge";
  }


  unsigned int
  AbutmentWedge::layers_before_dam() const
  {
    return dam_begin - begin;
  }


  bool
  AbutmentWedge::is_in_columns(const ArchDamCrossSection::Quad &quad) const
  {
    return quad.column >=
             unsigned(std::min(ledge.foot_column, ledge.side_column)) &&
           quad.column <
             unsigned(std::max(ledge.foot_column, ledge.side_column));
  }


  bool
  AbutmentWedge::contains(const ArchDamCrossSection::Quad &quad,
                          const unsigned int               layer) const
  {
    return !quad.inside && is_in_columns(quad) && row(quad) >= ledge.row &&
           layer >= begin && layer < end;
  }


  bool
  AbutmentWedge::is_cut(const ArchDamCrossSection::Quad &quad,
                        const unsigned int               layer) const
  {
    return !quad.inside && is_in_columns(quad) && row(quad) >= ledge.row &&
           layer >= cut_begin && layer < begin;
  }


  void
  AbutmentWedge::add_sets(const ArchDamCrossSection       &section,
                          const std::vector<unsigned int> &cell_number,
                          CoarseMesh                      &mesh) const
  {
    const std::string                                  name = this->name();
    const std::string                                  base = " base";
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
              const auto       &quad = section.quads[place[other].first];
              const std::string plane =
                place[other].second >= end ? " rear plane" :
                row(quad) < ledge.row      ? base :
                                             " lateral plane";
              mesh.face_sets[name + plane].push_back({cell, face});
              if (plane == base)
                for (const auto &side :
                     {CoarseMesh::Face{cell, face}, neighbours[cell][face]})
                  mesh.chart.surfaces[1].faces.push_back(side);
            }
        }
  }
} // namespace Voussoir
