#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/mesh/abutment_wedge.h>
#include <voussoir/mesh/arch_dam_section.h>
#include <voussoir/mesh/arch_dam_sweep.h>
#include <voussoir/mesh/generator.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Columns between the abutments that the shape of a dam needs.
    constexpr double least_columns = 8.;


    /** An arch dam in its canyon. */
    class ArchDam : public MeshGenerator
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Shape",
                          shape_name,
                          "A built-in dam, or \"custom\" for the one that the "
                          "section \"Custom shape\" describes, which is "
                          "ignored otherwise.",
                          Patterns::Selection(
                            join(ArchDamShape::preset_names(), "|") +
                            "|custom"));
        prm.add_parameter("Joints",
                          n_joints,
                          "Number of contraction joints, at equal distances "
                          "along the crest.",
                          Patterns::Integer(0));
        prm.add_parameter("Cell size",
                          cell_size,
                          "Length of the dam's cells along the crest [m]; "
                          "rounded so that cells fill the blocks.",
                          Patterns::Double(1e-3));
        prm.add_parameter("Cells through thickness",
                          n_thickness,
                          "Number of cells from the downstream to the upstream "
                          "face.",
                          Patterns::Integer(1));
        prm.add_parameter("Rock extent",
                          rock_extent,
                          "Rock below and on all sides of the dam over its "
                          "height [-].",
                          Patterns::Double(1., 20.));
        prm.add_parameter("Growth",
                          growth,
                          "Size ratio of successive layers of rock away from "
                          "the dam [-].",
                          Patterns::Double(1., 2.));
        prm.add_parameter(
          "Largest rock cell",
          largest_cell,
          "At which the rock's cells stop growing [m]; waves need about eight "
          "cells per wavelength, so 60 m of rock with S waves of 2000 m/s carry "
          "4 Hz.",
          Patterns::Double(1.));
        prm.add_parameter(
          "Reservoir level",
          water_level,
          "Fill the canyon with water up to the row of cells nearest to this "
          "level, cell set \"reservoir\" [m above the base]; 0: no water.",
          Patterns::Double(0.));
        prm.add_parameter("Reservoir length",
                          relative_water_length,
                          "From the crown upstream over the dam's height, "
                          "rounded to whole cells [-]; 0: to the end of the "
                          "rock.",
                          Patterns::Double(0., 20.));
        for (const int bank : {0, 1})
          {
            prm.enter_subsection(wedge_section(bank));
            wedges[bank].declare(prm);
            prm.leave_subsection();
          }
        prm.enter_subsection("Custom shape");
        custom_shape.declare(prm);
        prm.leave_subsection();
      }

      void
      check() const override
      {
        custom_shape.check("Mesh/arch dam/Custom shape");
        if (water_level > shape().height)
          {
            std::ostringstream text;
            text << "\"Reservoir level\" in section \"Mesh/arch dam\" is "
                 << water_level << " m, but the dam is only " << shape().height
                 << " m high; choose a lower level.";
            throw UserError(text.str());
          }
        if (water_level > 0. && relative_water_length > rock_extent)
          throw UserError("\"Reservoir length\" in section \"Mesh/arch dam\" "
                          "is more than the \"Rock extent\"; shorten the "
                          "reservoir or add rock.");
      }

      CoarseMesh
      generate() const override;

    private:
      ArchDamShape
      shape() const
      {
        return shape_name == "custom" ? custom_shape :
                                        ArchDamShape::preset(shape_name);
      }

      /** Those that are asked for; they lay lines of the section straight. */
      std::vector<AbutmentWedge>
      make_wedges(const ArchDamSweep        &sweep,
                  const ArchDamCrossSection &section) const;

      static std::string
      wedge_section(const int bank)
      {
        return bank == 0 ? "Right wedge" : "Left wedge";
      }

      std::string  shape_name            = "Baihetan-like";
      unsigned int n_joints              = 9;
      double       cell_size             = 16.;
      unsigned int n_thickness           = 2;
      double       rock_extent           = 2.;
      double       growth                = 1.4;
      double       largest_cell          = 60.;
      double       water_level           = 0.;
      double       relative_water_length = 0.;
      ArchDamShape custom_shape;

      std::array<AbutmentWedgeParameters, 2> wedges; // right and left bank
    };


    std::vector<AbutmentWedge>
    ArchDam::make_wedges(const ArchDamSweep        &sweep,
                         const ArchDamCrossSection &section) const
    {
      const AbutmentWedge::Layers layers{sweep.first_in_dam,
                                         sweep.first_in_dam + n_thickness,
                                         sweep.n_layers,
                                         [&](const double length) {
                                           return sweep.layers_along(length);
                                         }};
      std::vector<AbutmentWedge>  result;
      for (const unsigned int bank : {0, 1})
        if (wedges[bank].elevation > 0.)
          result.emplace_back(wedges[bank],
                              bank,
                              layers,
                              section,
                              "Mesh/arch dam/" + wedge_section(bank));
      return result;
    }


    CoarseMesh
    ArchDam::generate() const
    {
      const ArchDamShape    shape = this->shape();
      const ArchDamSections sections(shape);
      const double          crest = sections.left_end - sections.right_end;
      // Columns are halved in the cross-section.
      const unsigned int n_blocks = n_joints + 1;
      const double columns = std::max(least_columns, crest / (2. * cell_size));
      const unsigned int columns_per_block =
        std::max(1., std::round(columns / n_blocks));
      std::array<ArchDamCrossSection::Ledge, 2> ledges;
      for (const unsigned int bank : {0, 1})
        {
          ledges[bank].elevation = wedges[bank].elevation;
          ledges[bank].width     = wedges[bank].width;
        }
      const ArchDamCrossSection section(sections,
                                        shape.height,
                                        n_blocks,
                                        columns_per_block,
                                        rock_extent,
                                        growth,
                                        largest_cell,
                                        water_level,
                                        ledges);
      const ArchDamSweep        sweep(section,
                               sections,
                               shape.height,
                               rock_extent,
                               n_thickness,
                               cell_size,
                               growth,
                               largest_cell);
      const auto                bank_wedges = make_wedges(sweep, section);
      const unsigned int        n_lines     = section.vertices.size();
      const unsigned int        n_layers    = sweep.n_layers;
      const unsigned int        dam_begin   = sweep.first_in_dam,
                         dam_end            = dam_begin + n_thickness;
      const unsigned int water_end =
        relative_water_length > 0. ?
          dam_end + sweep.layers_along(relative_water_length * shape.height) :
          n_layers;
      const auto is_water = [&](const auto &quad, const unsigned int layer) {
        return quad.inside && quad.half_row < section.surface_row &&
               layer >= dam_end && layer < water_end;
      };

      // The cells, and which of them stands at a quadrilateral and layer.
      CoarseMesh                mesh;
      constexpr unsigned int    none = numbers::invalid_unsigned_int;
      std::vector<unsigned int> vertex_number(n_lines * (n_layers + 1), none);
      std::vector<unsigned int> cell_number(section.quads.size() * n_layers,
                                            none);
      for (unsigned int q = 0; q < section.quads.size(); ++q)
        for (unsigned int j = 0; j < n_layers; ++j)
          {
            const auto &quad   = section.quads[q];
            const bool  is_dam = j >= dam_begin && j < dam_end && quad.inside;
            if (quad.inside && !is_dam && !is_water(quad, j))
              continue;
            if (std::any_of(bank_wedges.begin(),
                            bank_wedges.end(),
                            [&](const AbutmentWedge &wedge) {
                              return wedge.is_cut(quad, j);
                            }))
              continue;
            const unsigned int cell       = mesh.cells.size();
            cell_number[q * n_layers + j] = cell;
            mesh.cell_sets[is_dam      ? "dam" :
                           quad.inside ? "reservoir" :
                                         "rock"]
              .push_back(cell);
            if (is_dam)
              mesh
                .cell_sets["block " +
                           std::to_string(
                             (quad.column - section.first_dam_column) /
                               columns_per_block +
                             1)]
                .push_back(cell);

            std::array<unsigned int, 8>           corners;
            constexpr std::array<unsigned int, 4> corner{{0, 1, 3, 2}};
            for (unsigned int v = 0; v < 8; ++v)
              {
                const unsigned int line =
                  quad.vertices[corner[(v & 1) + 2 * (v >> 2)]];
                corners[v] = line * (n_layers + 1) + j + ((v >> 1) & 1);
                vertex_number[corners[v]] = 0;
              }
            mesh.cells.push_back(corners);
          }

      for (unsigned int line = 0; line < n_lines; ++line)
        {
          const std::vector<Point<2>> points = sweep(line);
          for (unsigned int j = 0; j <= n_layers; ++j)
            {
              auto &number = vertex_number[line * (n_layers + 1) + j];
              if (number == none)
                continue;
              number = mesh.vertices.size();
              mesh.vertices.emplace_back(points[j][0],
                                         points[j][1],
                                         section.vertices[line].z);
            }
        }
      for (auto &cell : mesh.cells)
        for (unsigned int &vertex : cell)
          vertex = vertex_number[vertex];

      // Faces at the ends of the sweep.
      const auto name_face = [&](const std::string &name,
                                 const unsigned int quad,
                                 const unsigned int layer,
                                 const unsigned int face) {
        // rock may be cut away before a wedge
        if (const unsigned int cell = cell_number[quad * n_layers + layer];
            cell != none)
          mesh.face_sets[name].push_back({cell, face});
      };
      for (unsigned int q = 0; q < section.quads.size(); ++q)
        if (section.quads[q].inside)
          {
            name_face("downstream face", q, dam_begin, 2);
            name_face("upstream face", q, dam_end - 1, 3);
            if (is_water(section.quads[q], water_end - 1))
              name_face("reservoir end", q, water_end - 1, 3);
          }
        else
          {
            name_face("downstream end", q, 0, 2);
            name_face("upstream end", q, n_layers - 1, 3);
          }

      // Faces along the sweep, from the edges of the cross-section: edge e of
      // a quadrilateral runs from its vertex e to the next.
      struct Side
      {
        unsigned int quad, edge;
      };
      std::map<std::pair<unsigned int, unsigned int>, std::vector<Side>> edges;
      for (unsigned int q = 0; q < section.quads.size(); ++q)
        for (unsigned int e = 0; e < 4; ++e)
          {
            const auto &vertices = section.quads[q].vertices;
            edges[std::minmax(vertices[e], vertices[(e + 1) % 4])].push_back(
              {q, e});
          }
      constexpr std::array<unsigned int, 4> face_of_edge{{4, 1, 5, 0}};
      const auto name_faces = [&](const std::string &name,
                                  const Side        &side,
                                  const unsigned int begin,
                                  const unsigned int end) {
        for (unsigned int j = begin; j < end; ++j)
          name_face(name, side.quad, j, face_of_edge[side.edge]);
      };
      for (const auto &[ends, sides] : edges)
        {
          const auto &a         = section.vertices[ends.first],
                     &b         = section.vertices[ends.second];
          const auto &quad      = section.quads[sides[0].quad];
          const bool  on_column = a.column >= 0 && a.column == b.column;
          if (sides.size() == 1)
            {
              if (quad.inside)
                {
                  name_faces("crest", sides[0], dam_begin, dam_end);
                  if (is_water(quad, dam_end))
                    name_faces("water surface", sides[0], dam_end, water_end);
                }
              else if (on_column && a.column == 0)
                name_faces("right", sides[0], 0, n_layers);
              else if (on_column && a.column == section.last_column)
                name_faces("left", sides[0], 0, n_layers);
              else
                name_faces(a.z > 0. ? "ground" : "bottom",
                           sides[0],
                           0,
                           n_layers);
              continue;
            }

          const auto &other = section.quads[sides[1].quad];
          if (quad.inside != other.inside)
            {
              const Side &dam  = sides[quad.inside ? 0 : 1],
                         &rock = sides[quad.inside ? 1 : 0];
              name_faces("dam-rock interface", dam, dam_begin, dam_end);
              name_faces("canyon", rock, 0, dam_begin);
              name_faces("canyon", rock, dam_end, n_layers);
              name_faces("canyon downstream", rock, 0, dam_begin);
              name_faces("canyon upstream", rock, dam_end, n_layers);
            }
          else if (quad.inside && (quad.half_row < section.surface_row) !=
                                    (other.half_row < section.surface_row))
            name_faces("water surface",
                       sides[quad.half_row < section.surface_row ? 0 : 1],
                       dam_end,
                       water_end);
          else if (quad.inside && on_column &&
                   (a.column - section.first_dam_column) % columns_per_block ==
                     0)
            name_faces("joint " +
                         std::to_string((a.column - section.first_dam_column) /
                                        columns_per_block),
                       sides[quad.column < other.column ? 0 : 1],
                       dam_begin,
                       dam_end);
        }
      for (const AbutmentWedge &wedge : bank_wedges)
        wedge.add_sets(section, cell_number, mesh);
      return mesh;
    }

    const Registry<MeshGenerator>::Add<ArchDam>
      registered("arch dam", "An arch dam in its canyon.");
  } // namespace
} // namespace Voussoir
