#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/mesh/interface_surface.h>
#include <voussoir/mesh/interfaces.h>
#include <voussoir/mesh/mesh_geometry.h>

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;

  using Face = CoarseMesh::Face;

  namespace
  {
    // The interface of a face, given by cell and face, from either side.
    using SplitFaces =
      std::map<std::pair<unsigned int, unsigned int>, const InterfaceSurface *>;

    // New vertices at the place of an old one.
    using VertexCopies = std::map<unsigned int, std::vector<unsigned int>>;


    template <typename Set>
    const Set &
    find_set(const std::map<std::string, Set> &sets,
             const std::string                &name,
             const char                       *kind,
             const std::string                &place)
    {
      const auto set = sets.find(name);
      if (set != sets.end())
        return set->second;
      std::vector<std::string> known;
      for (const auto &item : sets)
        known.push_back(item.first);
      throw UserError(place + " names the " + kind + " set \"" + name +
                      "\", which the mesh does not have" +
                      known_names(name, known) + ".");
    }


    // Gives a vertex of its own to each group of cells around a vertex that are
    // connected through faces outside the interfaces. Returns the copies.
    std::vector<unsigned int>
    split_vertex(CoarseMesh                      &mesh,
                 const FaceNeighbours            &neighbours,
                 const SplitFaces                &split_faces,
                 const unsigned int               vertex,
                 const std::vector<unsigned int> &cells)
    {
      std::vector<unsigned int> copies;
      const auto position = [&](const unsigned int cell) -> unsigned int {
        return std::lower_bound(cells.begin(), cells.end(), cell) -
               cells.begin();
      };
      boost::disjoint_sets_with_storage<> groups(cells.size());
      for (unsigned int i = 0; i < cells.size(); ++i)
        {
          const auto        &corners = mesh.cells[cells[i]];
          const unsigned int corner =
            std::find(corners.begin(), corners.end(), vertex) - corners.begin();
          // the three faces at this corner
          for (unsigned int d = 0; d < 3; ++d)
            {
              const unsigned int face  = 2 * d + ((corner >> d) & 1);
              const Face        &other = neighbours[cells[i]][face];
              if (other.cell != none &&
                  split_faces.count({cells[i], face}) == 0)
                groups.union_set(i, position(other.cell));
            }
        }
      // the vertex itself stays with the first cell
      std::map<std::size_t, unsigned int> number_of_group{
        {groups.find_set(0), vertex}};
      for (unsigned int i = 0; i < cells.size(); ++i)
        {
          const auto [entry, is_new] =
            number_of_group.insert({groups.find_set(i), mesh.vertices.size()});
          if (is_new)
            {
              copies.push_back(entry->second);
              mesh.vertices.push_back(Point<3>(mesh.vertices[vertex]));
              if (auto &coordinates = mesh.chart.vertices; !coordinates.empty())
                coordinates.push_back(Point<3>(coordinates[vertex]));
            }
          auto &corners = mesh.cells[cells[i]];
          std::replace(corners.begin(), corners.end(), vertex, entry->second);
        }
      return copies;
    }


    SplitFaces
    collect_faces(const CoarseMesh                    &mesh,
                  const std::vector<InterfaceSurface> &interfaces,
                  const std::string                   &place)
    {
      SplitFaces result;
      for (const InterfaceSurface &interface : interfaces)
        for (const auto &sides : interface.faces)
          for (const Face &face : sides)
            {
              const auto [entry, is_new] =
                result.insert({{face.cell, face.face}, &interface});
              if (!is_new)
                throw UserError(place + ": " + describe_face(mesh, face) +
                                " belongs to \"" + entry->second->name +
                                "\" and \"" + interface.name +
                                "\"; a face can belong to one interface only.");
            }
      return result;
    }


    VertexCopies
    split_vertices(CoarseMesh                          &mesh,
                   const FaceNeighbours                &neighbours,
                   const std::vector<InterfaceSurface> &interfaces,
                   const SplitFaces                    &split_faces)
    {
      std::map<unsigned int, std::vector<unsigned int>> cells_at_vertex;
      for (const InterfaceSurface &interface : interfaces)
        for (const auto &sides : interface.faces)
          for (const unsigned int vertex : face_vertices(mesh, sides[0]))
            cells_at_vertex[vertex];
      for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
        for (const unsigned int vertex : mesh.cells[cell])
          if (const auto entry = cells_at_vertex.find(vertex);
              entry != cells_at_vertex.end())
            entry->second.push_back(cell);
      VertexCopies copies;
      for (const auto &[vertex, cells] : cells_at_vertex)
        copies[vertex] =
          split_vertex(mesh, neighbours, split_faces, vertex, cells);
      return copies;
    }


    void
    name_sides(CoarseMesh             &mesh,
               const InterfaceSurface &interface,
               const std::string      &place)
    {
      auto &first = mesh.face_sets[interface.name];
      auto &other = mesh.face_sets[interface.name + other_side];
      first.clear();
      for (const auto &sides : interface.faces)
        {
          auto a = face_vertices(mesh, sides[0]),
               b = face_vertices(mesh, sides[1]);
          std::sort(a.begin(), a.end());
          std::sort(b.begin(), b.end());
          if (a == b)
            throw UserError(
              place + ": the interface \"" + interface.name +
              "\" cannot open at " + describe_face(mesh, sides[0]) +
              ", because all vertices of this face lie where it ends inside "
              "the body; use smaller cells or extend the interface.");
          first.push_back(sides[0]);
          other.push_back(sides[1]);
        }
    }


    void
    add_copies_to_sets(CoarseMesh &mesh, const VertexCopies &copies)
    {
      for (auto &set : mesh.vertex_sets)
        {
          const std::vector<unsigned int> members = set.second;
          for (const unsigned int vertex : members)
            if (const auto entry = copies.find(vertex); entry != copies.end())
              set.second.insert(set.second.end(),
                                entry->second.begin(),
                                entry->second.end());
        }
    }
  } // namespace


  std::vector<Face>
  faces_between(const CoarseMesh  &mesh,
                const std::string &cell_set,
                const std::string &other_cell_set,
                const std::string &place)
  {
    std::vector<std::array<bool, 2>> is_member(mesh.cells.size(),
                                               {{false, false}});
    for (const unsigned int side : {0, 1})
      for (const unsigned int cell :
           find_set(mesh.cell_sets,
                    side == 0 ? cell_set : other_cell_set,
                    "cell",
                    place))
        is_member[cell][side] = true;
    std::vector<Face>    result;
    const FaceNeighbours neighbours = find_face_neighbours(mesh);
    for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
      if (is_member[cell][0])
        {
          if (is_member[cell][1])
            throw UserError(place + ": the cell sets \"" + cell_set +
                            "\" and \"" + other_cell_set +
                            "\" have cells in common, so there is no interface "
                            "between them; choose sets that lie side by side.");
          for (unsigned int face = 0; face < 6; ++face)
            if (const Face &other = neighbours[cell][face];
                other.cell != none && is_member[other.cell][1])
              result.push_back({cell, face});
        }
    if (result.empty())
      throw UserError(place + ": the cell sets \"" + cell_set + "\" and \"" +
                      other_cell_set +
                      "\" share no face, so there is no interface between "
                      "them; choose sets that lie side by side.");
    return result;
  }


  void
  split_interfaces(CoarseMesh                     &mesh,
                   const std::vector<std::string> &face_sets,
                   const std::string              &place)
  {
    const FaceNeighbours          neighbours = find_face_neighbours(mesh);
    std::vector<InterfaceSurface> interfaces;
    for (const std::string &name : face_sets)
      {
        interfaces.push_back(
          make_interface_surface(mesh,
                                 neighbours,
                                 name,
                                 find_set(mesh.face_sets, name, "face", place),
                                 place));
        if (mesh.face_sets.count(name + other_side) > 0)
          throw UserError(place + ": the mesh has a face set \"" + name +
                          other_side +
                          "\" already, which is the name of the second side "
                          "of \"" +
                          name + "\"; rename it.");
      }
    const SplitFaces   split_faces = collect_faces(mesh, interfaces, place);
    const VertexCopies copies =
      split_vertices(mesh, neighbours, interfaces, split_faces);
    for (const InterfaceSurface &interface : interfaces)
      name_sides(mesh, interface, place);
    add_copies_to_sets(mesh, copies);
  }
} // namespace Voussoir
