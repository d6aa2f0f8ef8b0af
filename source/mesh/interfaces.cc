#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/mesh/interface_surface.h>
#include <voussoir/mesh/interfaces.h>
#include <voussoir/mesh/mesh_geometry.h>

#include <algorithm>
#include <numeric>

namespace Voussoir
{
  using namespace dealii;

  using Face = CoarseMesh::Face;

  namespace
  {
    constexpr unsigned int none = numbers::invalid_unsigned_int;

    // Number of the interface of a face, from either side.
    using InterfaceNumbers =
      std::map<std::pair<unsigned int, unsigned int>, unsigned int>;


    template <typename Set>
    const Set &
    find_set(const std::map<std::string, Set> &sets,
             const std::string                &name,
             const std::string                &kind,
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


    /** Numbers that are joined into groups. */
    class Groups
    {
    public:
      explicit Groups(const unsigned int n)
        : parent(n)
      {
        std::iota(parent.begin(), parent.end(), 0U);
      }

      /** The lowest number of the group. */
      unsigned int
      lowest(unsigned int i)
      {
        while (parent[i] != i)
          i = parent[i] = parent[parent[i]];
        return i;
      }

      void
      join(const unsigned int i, const unsigned int j)
      {
        const auto [a, b] = std::minmax({lowest(i), lowest(j)});
        parent[b]         = a;
      }

    private:
      std::vector<unsigned int> parent;
    };


    // Give the cells around a vertex that hang together through faces outside
    // the interfaces vertices of their own. Returns the copies.
    std::vector<unsigned int>
    split_vertex(CoarseMesh                      &mesh,
                 const FaceNeighbours            &neighbours,
                 const InterfaceNumbers          &split_faces,
                 const unsigned int               vertex,
                 const std::vector<unsigned int> &cells)
    {
      std::vector<unsigned int> copies;
      const auto                position = [&](const unsigned int cell) {
        return std::lower_bound(cells.begin(), cells.end(), cell) -
               cells.begin();
      };
      Groups groups(cells.size());
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
                groups.join(i, position(other.cell));
            }
        }
      std::map<unsigned int, unsigned int> number_of_group{{0, vertex}};
      for (unsigned int i = 0; i < cells.size(); ++i)
        {
          const auto [entry, is_new] =
            number_of_group.insert({groups.lowest(i), mesh.vertices.size()});
          if (is_new)
            {
              copies.push_back(entry->second);
              mesh.vertices.push_back(Point<3>(mesh.vertices[vertex]));
            }
          auto &corners = mesh.cells[cells[i]];
          std::replace(corners.begin(), corners.end(), vertex, entry->second);
        }
      return copies;
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
    InterfaceNumbers              interface_of_face;
    for (const std::string &name : face_sets)
      {
        interfaces.push_back(
          make_interface_surface(mesh,
                                 neighbours,
                                 name,
                                 find_set(mesh.face_sets, name, "face", place),
                                 place));
        for (const auto &sides : interfaces.back().faces)
          for (const Face &face : sides)
            {
              const auto [entry, is_new] = interface_of_face.insert(
                {{face.cell, face.face},
                 static_cast<unsigned int>(interfaces.size() - 1)});
              if (!is_new)
                throw UserError(
                  place + ": " + describe_face(mesh, face) + " belongs to \"" +
                  interfaces[entry->second].name + "\" and \"" + name +
                  "\"; a face can belong to one interface only.");
            }
        if (mesh.face_sets.count(name + other_side) > 0)
          throw UserError(place + ": the mesh has a face set \"" + name +
                          other_side +
                          "\" already, which is the name of the second side "
                          "of \"" +
                          name + "\"; rename it.");
      }

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
    std::map<unsigned int, std::vector<unsigned int>> copies;
    for (const auto &[vertex, cells] : cells_at_vertex)
      copies[vertex] =
        split_vertex(mesh, neighbours, interface_of_face, vertex, cells);

    for (const InterfaceSurface &interface : interfaces)
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
} // namespace Voussoir
