#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/mesh/mesh_geometry.h>
#include <voussoir/mesh/reservoir_mesh.h>

#include <deal.II/numerics/rtree.h>

#include <optional>
#include <set>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    std::vector<bool>
    water_cells(const CoarseMesh               &mesh,
                const std::vector<std::string> &cell_sets,
                const std::string              &place)
    {
      std::vector<std::string> known;
      for (const auto &item : mesh.cell_sets)
        known.push_back(item.first);
      std::vector<bool> is_water(mesh.cells.size());
      for (const std::string &name : cell_sets)
        {
          const auto set = mesh.cell_sets.find(name);
          if (set == mesh.cell_sets.end())
            throw UserError(place + " names the cell set \"" + name +
                            "\", which the mesh does not have" +
                            known_names(name, known) + ".");
          for (const unsigned int cell : set->second)
            is_water[cell] = true;
        }
      return is_water;
    }


    // The two sides of each face between water and the rest.
    std::vector<std::array<CoarseMesh::Face, 2>>
    shared_faces(const CoarseMesh &mesh, const std::vector<bool> &is_water)
    {
      std::vector<std::array<CoarseMesh::Face, 2>> result;
      const std::vector<SortedFace>                faces = sorted_faces(mesh);
      for (std::size_t i = 1; i < faces.size(); ++i)
        if (faces[i].vertices == faces[i - 1].vertices &&
            is_water[faces[i].face.cell] != is_water[faces[i - 1].face.cell])
          result.push_back({{faces[i - 1].face, faces[i].face}});
      return result;
    }


    /** An outer face as a plane piece. */
    struct Piece
    {
      Piece(const CoarseMesh &mesh, const CoarseMesh::Face &face)
        : size(std::sqrt(face_area(mesh, face)))
      {
        const auto v = face_vertices(mesh, face);
        for (const unsigned int vertex : v)
          centre += 0.25 * mesh.vertices[vertex];
        normal = cross_product_3d(mesh.vertices[v[3]] - mesh.vertices[v[0]],
                                  mesh.vertices[v[2]] - mesh.vertices[v[1]]);
        normal /= normal.norm();
        if (normal * (centre - cell_centre(mesh, face.cell)) < 0.)
          normal *= -1.;
      }

      /** Distance to another piece that faces this one; none if the other is
       *  not in front of this piece, or further away than the size of this
       *  piece. */
      std::optional<double>
      distance_to(const Piece &other) const
      {
        const Tensor<1, 3> way   = other.centre - centre;
        const double       ahead = way * normal;
        if (other.normal * normal > -0.7 || ahead < 0. || ahead > size ||
            (way - ahead * normal).norm() > 0.5 * (size + other.size))
          return {};
        return ahead;
      }

      Point<3>     centre;
      Tensor<1, 3> normal; // outwards
      double       size;
    };


    // Refuses a gap at water that was meshed on its own, as the water would not
    // press on the dam across it.
    void
    check_gap(const CoarseMesh               &mesh,
              const std::vector<bool>        &is_water,
              const std::vector<std::string> &open_faces,
              const std::string              &place)
    {
      std::set<std::pair<unsigned int, unsigned int>> open;
      for (const std::string &name : open_faces)
        if (const auto faces = mesh.face_sets.find(name);
            faces != mesh.face_sets.end())
          for (const CoarseMesh::Face &face : faces->second)
            open.emplace(face.cell, face.face);

      const std::vector<SortedFace> faces    = sorted_faces(mesh);
      const auto                    is_outer = [&faces](const std::size_t i) {
        return (i == 0 || faces[i].vertices != faces[i - 1].vertices) &&
               (i + 1 == faces.size() ||
                faces[i].vertices != faces[i + 1].vertices);
      };
      std::vector<Piece>    water, solid;
      std::vector<Point<3>> centres; // of the solid
      for (std::size_t i = 0; i < faces.size(); ++i)
        {
          const CoarseMesh::Face &face = faces[i].face;
          if (!is_outer(i) || open.count({face.cell, face.face}) > 0)
            continue;
          if (is_water[face.cell])
            water.emplace_back(mesh, face);
          else
            {
              solid.emplace_back(mesh, face);
              centres.push_back(solid.back().centre);
            }
        }
      const auto tree = pack_rtree_of_indices(centres);
      for (const Piece &piece : water)
        {
          constexpr unsigned int   n_nearest = 8;
          std::vector<std::size_t> near;
          tree.query(boost::geometry::index::nearest(piece.centre, n_nearest),
                     std::back_inserter(near));
          for (const std::size_t other : near)
            if (const auto gap = piece.distance_to(solid[other]))
              {
                std::ostringstream text;
                text << place << ": at (" << piece.centre
                     << ") m the water leaves a gap of " << *gap
                     << " m to the rest of the mesh; mesh both together, so "
                        "that they have common nodes.";
                throw UserError(text.str());
              }
        }
    }


    // The cells of @p mesh for which @p kept is true, with their sets.
    CoarseMesh
    part(const CoarseMesh &mesh, const std::vector<bool> &kept)
    {
      CoarseMesh result;
      result.chart.positions = mesh.chart.positions;
      result.chart.onto_edge = mesh.chart.onto_edge;
      std::vector<unsigned int> vertex_number(mesh.vertices.size(), none),
        cell_number(mesh.cells.size(), none);
      for (unsigned int c = 0; c < mesh.cells.size(); ++c)
        if (kept[c])
          {
            cell_number[c] = result.cells.size();
            result.cells.push_back(mesh.cells[c]);
            for (unsigned int &vertex : result.cells.back())
              {
                if (vertex_number[vertex] == none)
                  {
                    vertex_number[vertex] = result.vertices.size();
                    result.vertices.push_back(mesh.vertices[vertex]);
                    if (!mesh.chart.vertices.empty())
                      result.chart.vertices.push_back(
                        mesh.chart.vertices[vertex]);
                  }
                vertex = vertex_number[vertex];
              }
          }
      for (const auto &[name, cells] : mesh.cell_sets)
        for (const unsigned int cell : cells)
          if (kept[cell])
            result.cell_sets[name].push_back(cell_number[cell]);
      for (const auto &[name, faces] : mesh.face_sets)
        for (const CoarseMesh::Face &face : faces)
          if (kept[face.cell])
            result.face_sets[name].push_back(
              {cell_number[face.cell], face.face});
      for (const auto &surface : mesh.chart.surfaces)
        {
          result.chart.surfaces.push_back({{}, surface.onto});
          for (const CoarseMesh::Face &face : surface.faces)
            if (kept[face.cell])
              result.chart.surfaces.back().faces.push_back(
                {cell_number[face.cell], face.face});
        }
      for (const auto &[name, vertices] : mesh.vertex_sets)
        for (const unsigned int vertex : vertices)
          if (vertex_number[vertex] != none)
            result.vertex_sets[name].push_back(vertex_number[vertex]);
      return result;
    }
  } // namespace


  CoarseMesh
  split_off_reservoir(CoarseMesh                     &mesh,
                      const std::vector<std::string> &cell_sets,
                      const std::string              &place,
                      const std::vector<std::string> &open_faces)
  {
    std::vector<bool> is_water = water_cells(mesh, cell_sets, place);
    const auto        shared   = shared_faces(mesh, is_water);
    if (shared.empty())
      throw UserError(place + ": the water \"" + join(cell_sets, ", ") +
                      "\" shares no face with the rest of the mesh; mesh water "
                      "and dam together, so that they have common nodes.");
    check_gap(mesh, is_water, open_faces, place);

    // each shared face, from both its sides
    std::map<std::pair<unsigned int, unsigned int>, CoarseMesh::Face>
      other_side;
    for (const auto &[a, b] : shared)
      {
        other_side[{a.cell, a.face}] = b;
        other_side[{b.cell, b.face}] = a;
      }
    for (auto &item : mesh.face_sets)
      {
        std::set<std::pair<unsigned int, unsigned int>> members;
        for (const CoarseMesh::Face &face : item.second)
          members.emplace(face.cell, face.face);
        const std::vector<CoarseMesh::Face> named = item.second;
        for (const CoarseMesh::Face &face : named)
          if (const auto other = other_side.find({face.cell, face.face});
              other != other_side.end() &&
              members.emplace(other->second.cell, other->second.face).second)
            item.second.push_back(other->second);
      }
    for (const auto &sides : shared)
      for (const CoarseMesh::Face &face : sides)
        mesh.face_sets[wet_wall].push_back(face);

    CoarseMesh water = part(mesh, is_water);
    is_water.flip();
    mesh = part(mesh, is_water);
    return water;
  }
} // namespace Voussoir
