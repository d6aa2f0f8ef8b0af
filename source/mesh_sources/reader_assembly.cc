#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/mesh/mesh_geometry.h>
#include <voussoir/mesh_sources/reader_assembly.h>

#include <algorithm>
#include <limits>
#include <ostream>
#include <tuple>
#include <unordered_map>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    class Assembly
    {
    public:
      Assembly(const FileMesh    &file,
               const std::string &filename,
               std::ostream      *report)
        : file(file)
        , filename(filename)
        , report(report)
      {}

      CoarseMesh
      run()
      {
        refuse_other_elements();
        add_cells();
        turn_mirrored_cells();
        mesh.cell_sets = file.hexahedron_sets;
        add_faces();
        add_vertex_sets();
        remove_repetitions();
        return std::move(mesh);
      }

    private:
      void
      note(const std::string &text) const
      {
        if (report != nullptr)
          *report << filename << ": " << text << '\n';
      }


      void
      refuse_other_elements() const
      {
        std::vector<std::string> kinds;
        bool                     quadratic = false;
        for (const auto &[kind, number] : file.refused)
          {
            kinds.push_back(kind + ": " + std::to_string(number));
            quadratic |= (kind.find("nodes") != std::string::npos);
          }
        if (!kinds.empty())
          throw UserError(
            filename +
            ": only hexahedra with eight vertices can be computed, but there "
            "are other solids (" +
            join(kinds, ", ") + "); " +
            (quadratic ? "export elements of first order." :
                         "remesh these volumes with hexahedra or leave them "
                         "out of the export."));

        kinds.clear();
        for (const auto &[kind, number] : file.ignored)
          kinds.push_back(kind + ": " + std::to_string(number));
        if (!kinds.empty())
          note("ignored elements left out (" + join(kinds, ", ") + ")");
        if (file.hexahedra.empty())
          throw UserError(filename +
                          ": there is no hexahedron in the file; mesh the "
                          "volumes with hexahedra and export them as well (in "
                          "Gmsh, give each volume a physical group).");
      }


      void
      add_cells()
      {
        std::unordered_map<std::int64_t, const Point<3> *> positions;
        positions.reserve(file.vertices.size());
        for (const auto &[number, position] : file.vertices)
          if (!positions.emplace(number, &position).second &&
              *positions[number] != position)
            throw UserError(filename + ": node " + std::to_string(number) +
                            " is given twice with different coordinates; "
                            "number the nodes anew and export again.");

        for (const auto &hexahedron : file.hexahedra)
          {
            std::array<unsigned int, 8> cell;
            for (unsigned int i = 0; i < 8; ++i)
              {
                const std::int64_t number   = hexahedron.vertices[i];
                const auto         position = positions.find(number);
                if (position == positions.end())
                  throw UserError(
                    filename + ": element " +
                    std::to_string(hexahedron.number) + " names node " +
                    std::to_string(number) +
                    ", which the file does not give; export nodes "
                    "and elements together.");
                const auto [entry, is_new] =
                  indices.emplace(number, mesh.vertices.size());
                if (is_new)
                  mesh.vertices.push_back(*position->second);
                // around each quadrilateral -> lexicographic
                cell[i ^ ((i & 2) >> 1)] = entry->second;
              }
            mesh.cells.push_back(cell);
          }

        if (mesh.vertices.size() < positions.size())
          note(counted(positions.size() - mesh.vertices.size(),
                       "node that belongs",
                       "nodes that belong") +
               " to no hexahedron left out");
      }


      // A program that numbers the top before the bottom writes valid cells in
      // mirror order; an inverted cell that is turned overlaps its neighbour,
      // which check_mesh() finds.
      void
      turn_mirrored_cells()
      {
        is_turned.assign(mesh.cells.size(), false);
        for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
          {
            const auto shapes = corner_shapes(mesh, cell);
            if (*std::max_element(shapes.begin(), shapes.end()) < 0)
              {
                std::swap_ranges(mesh.cells[cell].begin(),
                                 mesh.cells[cell].begin() + 4,
                                 mesh.cells[cell].begin() + 4);
                is_turned[cell] = true;
              }
          }
        const auto n_turned =
          std::count(is_turned.begin(), is_turned.end(), true);
        if (n_turned > 0)
          note(counted(n_turned, "cell is", "cells are") +
               " numbered in mirror order and turned");
      }


      void
      add_faces()
      {
        for (const auto &[name, faces] : file.face_sets)
          for (CoarseMesh::Face face : faces)
            {
              if (is_turned[face.cell] && face.face >= 4)
                face.face = 9 - face.face;
              mesh.face_sets[name].push_back(face);
            }

        if (file.quadrilaterals.empty() && file.free_face_sets.empty())
          return;

        const std::vector<SortedFace> faces = sorted_faces(mesh);
        for (const auto &[name, indices] : file.quadrilateral_sets)
          add_quadrilaterals(name, indices, faces);

        const auto equal = [](const SortedFace &a, const SortedFace &b) {
          return a.vertices == b.vertices;
        };
        for (const auto &[name, cells] : file.free_face_sets)
          {
            std::vector<bool> is_member(mesh.cells.size(), false);
            for (const unsigned int cell : cells)
              is_member[cell] = true;
            for (unsigned int i = 0; i < faces.size(); ++i)
              if (is_member[faces[i].face.cell] &&
                  !(i > 0 && equal(faces[i - 1], faces[i])) &&
                  !(i + 1 < faces.size() && equal(faces[i], faces[i + 1])))
                mesh.face_sets[name].push_back(faces[i].face);
          }
      }


      void
      add_quadrilaterals(const std::string               &name,
                         const std::vector<unsigned int> &quadrilaterals,
                         const std::vector<SortedFace>   &faces)
      {
        unsigned int n_unmatched = 0;
        for (const unsigned int q : quadrilaterals)
          {
            std::array<unsigned int, 4> vertices;
            for (unsigned int i = 0; i < 4; ++i)
              {
                const auto entry =
                  indices.find(file.quadrilaterals[q].vertices[i]);
                vertices[i] = (entry == indices.end() ?
                                 std::numeric_limits<unsigned int>::max() :
                                 entry->second);
              }
            std::sort(vertices.begin(), vertices.end());
            const auto face =
              std::lower_bound(faces.begin(),
                               faces.end(),
                               vertices,
                               [](const SortedFace &face,
                                  const auto       &vertices) {
                                 return face.vertices < vertices;
                               });
            if (face != faces.end() && face->vertices == vertices)
              mesh.face_sets[name].push_back(face->face);
            else
              ++n_unmatched;
          }
        if (n_unmatched > 0)
          note(
            std::to_string(n_unmatched) + " of " +
            counted(quadrilaterals.size(), "quadrilateral", "quadrilaterals") +
            " of set \"" + name + "\" left out: not the face of a hexahedron");
      }


      void
      add_vertex_sets()
      {
        for (const auto &[name, numbers] : file.vertex_sets)
          {
            unsigned int n_unmatched = 0;
            for (const std::int64_t number : numbers)
              {
                const auto entry = indices.find(number);
                if (entry != indices.end())
                  mesh.vertex_sets[name].push_back(entry->second);
                else
                  ++n_unmatched;
              }
            if (n_unmatched > 0)
              note(std::to_string(n_unmatched) + " of " +
                   counted(numbers.size(), "node", "nodes") + " of set \"" +
                   name + "\" left out: not the node of a hexahedron");
          }
      }


      void
      remove_repetitions()
      {
        const auto tidy = [](auto &sets, const auto &key) {
          for (auto &[name, members] : sets)
            {
              std::sort(members.begin(),
                        members.end(),
                        [&](const auto &a, const auto &b) {
                          return key(a) < key(b);
                        });
              members.erase(std::unique(members.begin(),
                                        members.end(),
                                        [&](const auto &a, const auto &b) {
                                          return key(a) == key(b);
                                        }),
                            members.end());
            }
        };
        const auto itself = [](const unsigned int index) { return index; };
        tidy(mesh.cell_sets, itself);
        tidy(mesh.vertex_sets, itself);
        tidy(mesh.face_sets, [](const CoarseMesh::Face &face) {
          return std::make_pair(face.cell, face.face);
        });
      }

      const FileMesh    &file;
      const std::string &filename;
      std::ostream      *report;

      CoarseMesh                                     mesh;
      std::unordered_map<std::int64_t, unsigned int> indices;
      std::vector<bool>                              is_turned;
    };
  } // namespace


  CoarseMesh
  assemble_mesh(const FileMesh    &file,
                const std::string &filename,
                std::ostream      *report)
  {
    return Assembly(file, filename, report).run();
  }
} // namespace Voussoir
