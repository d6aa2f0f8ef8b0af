#include <voussoir/mesh_sources/arch_dam_mesh.h>

#include <algorithm>
#include <map>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    class ArchDamMesh
    {
    public:
      ArchDamMesh(const ArchDamCrossSection        &section,
                  const ArchDamSweep               &sweep,
                  const std::vector<AbutmentWedge> &wedges,
                  const unsigned int                columns_per_block,
                  const LiftJoints                 &lift_joints,
                  const unsigned int                water_end)
        : section(section)
        , sweep(sweep)
        , wedges(wedges)
        , columns_per_block(columns_per_block)
        , lift_joints(lift_joints)
        , n_layers(sweep.n_layers)
        , dam_begin(sweep.first_in_dam)
        , dam_end(n_layers - sweep.first_in_dam)
        , water_end(water_end)
        , vertex_number(section.vertices.size() * (n_layers + 1), none)
        , cell_number(section.quads.size() * n_layers, none)
      {
        mesh.chart.surfaces.resize(2);
      }

      CoarseMesh
      run()
      {
        for (unsigned int q = 0; q < section.quads.size(); ++q)
          for (unsigned int layer = 0; layer < n_layers; ++layer)
            if (is_filled(section.quads[q], layer))
              add_cell(q, layer);
        place_vertices();
        name_faces_across_sweep();
        name_faces_along_sweep();
        for (const AbutmentWedge &wedge : wedges)
          wedge.add_sets(section, cell_number, mesh);
        return std::move(mesh);
      }

    private:
      using Quad = ArchDamCrossSection::Quad;

      // An edge of the cross-section by its two vertices, the lower one first.
      using Edge = std::pair<unsigned int, unsigned int>;

      // Edge e of a quadrilateral runs from its vertex e to the next.
      struct Side
      {
        unsigned int quad, edge;
      };

      bool
      is_dam(const Quad &quad, const unsigned int layer) const
      {
        return quad.inside && layer >= dam_begin && layer < dam_end;
      }


      bool
      is_below_surface(const Quad &quad) const
      {
        return quad.inside && quad.half_row < section.surface_row;
      }


      bool
      is_water(const Quad &quad, const unsigned int layer) const
      {
        return is_below_surface(quad) && layer >= dam_end && layer < water_end;
      }


      bool
      is_filled(const Quad &quad, const unsigned int layer) const
      {
        if (quad.inside)
          return is_dam(quad, layer) || is_water(quad, layer);
        return std::none_of(wedges.begin(),
                            wedges.end(),
                            [&](const AbutmentWedge &wedge) {
                              return wedge.is_cut(quad, layer);
                            });
      }


      // Marks the vertices of the cell, which place_vertices() numbers.
      void
      add_cell(const unsigned int q, const unsigned int layer)
      {
        const Quad        &quad           = section.quads[q];
        const unsigned int cell           = mesh.cells.size();
        cell_number[q * n_layers + layer] = cell;
        if (is_dam(quad, layer))
          {
            const unsigned int block =
              (quad.column - section.first_dam_column) / columns_per_block + 1;
            mesh.cell_sets["dam"].push_back(cell);
            mesh.cell_sets["block " + std::to_string(block)].push_back(cell);
          }
        else
          mesh.cell_sets[quad.inside ? "reservoir" : "rock"].push_back(cell);

        std::array<unsigned int, 8>           vertices;
        constexpr std::array<unsigned int, 4> corner{{0, 1, 3, 2}};
        for (unsigned int v = 0; v < 8; ++v)
          {
            const unsigned int line =
              quad.vertices[corner[(v & 1) + 2 * (v >> 2)]];
            vertices[v] = line * (n_layers + 1) + layer + ((v >> 1) & 1);
            vertex_number[vertices[v]] = 0;
          }
        mesh.cells.push_back(vertices);
      }


      void
      place_vertices()
      {
        for (unsigned int line = 0; line < section.vertices.size(); ++line)
          {
            const std::vector<Point<3>> points = sweep(line);
            for (unsigned int j = 0; j <= n_layers; ++j)
              if (auto &number = vertex_number[line * (n_layers + 1) + j];
                  number != none)
                {
                  number = mesh.chart.vertices.size();
                  mesh.chart.vertices.push_back(points[j]);
                }
          }
        mesh.vertices = sweep.positions(mesh.chart.vertices);
        for (auto &cell : mesh.cells)
          for (unsigned int &vertex : cell)
            vertex = vertex_number[vertex];
      }


      // Visits a face, unless its rock is cut away in front of a wedge.
      template <typename Visitor>
      void
      visit_face(const unsigned int quad,
                 const unsigned int layer,
                 const unsigned int face,
                 const Visitor     &visit) const
      {
        if (const unsigned int cell = cell_number[quad * n_layers + layer];
            cell != none)
          visit(CoarseMesh::Face{cell, face});
      }


      void
      name_face(const std::string &name,
                const unsigned int quad,
                const unsigned int layer,
                const unsigned int face)
      {
        visit_face(quad, layer, face, [&](const CoarseMesh::Face &item) {
          mesh.face_sets[name].push_back(item);
        });
      }


      // Names the faces towards downstream and upstream.
      void
      name_faces_across_sweep()
      {
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
      }


      // Names the faces that the edges of the cross-section sweep out.
      void
      name_faces_along_sweep()
      {
        std::map<Edge, std::vector<Side>> edges;
        for (unsigned int q = 0; q < section.quads.size(); ++q)
          for (unsigned int e = 0; e < 4; ++e)
            {
              const auto &vertices = section.quads[q].vertices;
              edges[std::minmax(vertices[e], vertices[(e + 1) % 4])].push_back(
                {q, e});
            }
        for (const auto &[edge, sides] : edges)
          if (sides.size() == 1)
            name_outer_faces(edge, sides[0]);
          else
            name_inner_faces(edge, sides[0], sides[1]);
      }


      template <typename Visitor>
      void
      for_each_face(const Side        &side,
                    const unsigned int begin,
                    const unsigned int end,
                    const Visitor     &visit) const
      {
        constexpr std::array<unsigned int, 4> face_of_edge{{4, 1, 5, 0}};
        for (unsigned int layer = begin; layer < end; ++layer)
          visit_face(side.quad, layer, face_of_edge[side.edge], visit);
      }


      void
      name_faces(const std::string &name,
                 const Side        &side,
                 const unsigned int begin,
                 const unsigned int end)
      {
        for_each_face(side, begin, end, [&](const CoarseMesh::Face &face) {
          mesh.face_sets[name].push_back(face);
        });
      }


      // Column of the grid that the edge lies on; -1 if it lies on none.
      int
      column_of(const Edge &edge) const
      {
        const int column = section.vertices[edge.first].column;
        return column == section.vertices[edge.second].column ? column : -1;
      }


      void
      name_outer_faces(const Edge &edge, const Side &side)
      {
        const Quad &quad   = section.quads[side.quad];
        const int   column = column_of(edge);
        if (quad.inside)
          {
            name_faces("crest", side, dam_begin, dam_end);
            if (is_water(quad, dam_end))
              name_faces("water surface", side, dam_end, water_end);
          }
        else if (column == 0)
          name_faces("right", side, 0, n_layers);
        else if (column == section.last_column)
          name_faces("left", side, 0, n_layers);
        else
          name_faces(section.vertices[edge.first].z > 0. ? "ground" : "bottom",
                     side,
                     0,
                     n_layers);
      }


      void
      name_inner_faces(const Edge &edge, const Side &first, const Side &second)
      {
        const Quad &quad  = section.quads[first.quad],
                   &other = section.quads[second.quad];
        if (quad.inside != other.inside)
          name_contour(quad.inside ? first : second,
                       quad.inside ? second : first);
        else if (quad.inside)
          {
            // also between columns, where the water ends beside a bank
            if (is_below_surface(quad) != is_below_surface(other))
              name_faces("water surface",
                         is_below_surface(quad) ? first : second,
                         dam_end,
                         water_end);
            const int column = column_of(edge),
                      in_dam = column - section.first_dam_column;
            if (column >= 0 && in_dam % columns_per_block == 0)
              name_faces("joint " + std::to_string(in_dam / columns_per_block),
                         quad.column < other.column ? first : second,
                         dam_begin,
                         dam_end);
            else if (quad.half_row < other.half_row)
              name_lift_joint(second);
            else if (quad.half_row > other.half_row)
              name_lift_joint(first);
          }
      }


      // Names the lift joint below a quadrilateral of the dam, if there is one.
      void
      name_lift_joint(const Side &upper)
      {
        const int half_row = section.quads[upper.quad].half_row;
        if (const std::string joint =
              lift_joints.below(half_row - section.first_half_row());
            !joint.empty())
          name_faces(joint, upper, dam_begin, dam_end);
      }


      // Names the interface of dam and rock, and the walls of the canyon beside
      // it.
      void
      name_contour(const Side &dam, const Side &rock)
      {
        name_faces("dam-rock interface", dam, dam_begin, dam_end);
        name_faces("canyon", rock, 0, dam_begin);
        name_faces("canyon", rock, dam_end, n_layers);
        name_faces("canyon downstream", rock, 0, dam_begin);
        name_faces("canyon upstream", rock, dam_end, n_layers);
        auto &walls_of_canyon = mesh.chart.surfaces[0].faces;
        for (const Side &side : {dam, rock})
          for_each_face(side, 0, n_layers, [&](const CoarseMesh::Face &face) {
            walls_of_canyon.push_back(face);
          });
      }

      const ArchDamCrossSection        &section;
      const ArchDamSweep               &sweep;
      const std::vector<AbutmentWedge> &wedges;
      const unsigned int                columns_per_block;
      const LiftJoints                 &lift_joints;
      const unsigned int                n_layers, dam_begin, dam_end, water_end;

      CoarseMesh mesh;

      // Numbers of vertices by line of the sweep and point on the line, and of
      // cells by quadrilateral and layer.
      std::vector<unsigned int> vertex_number, cell_number;
    };
  } // namespace


  CoarseMesh
  make_arch_dam_mesh(const ArchDamCrossSection        &section,
                     const ArchDamSweep               &sweep,
                     const std::vector<AbutmentWedge> &wedges,
                     const unsigned int                columns_per_block,
                     const LiftJoints                 &lift_joints,
                     const unsigned int                water_end)
  {
    return ArchDamMesh(
             section, sweep, wedges, columns_per_block, lift_joints, water_end)
      .run();
  }
} // namespace Voussoir
