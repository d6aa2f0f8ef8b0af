#include <voussoir/base/error.h>
#include <voussoir/mesh/interface_surface.h>
#include <voussoir/mesh/mesh_geometry.h>

#include <algorithm>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  using Face = CoarseMesh::Face;

  namespace
  {
    // Number of each face of an interface, given from either side.
    using FaceNumbers = std::map<std::pair<unsigned int, unsigned int>, int>;


    /**
     * Finds which sides of two faces with a common edge are connected through
     * cells around this edge.
     */
    class Surface
    {
    public:
      Surface(const CoarseMesh       &mesh,
              const FaceNeighbours   &neighbours,
              const InterfaceSurface &interface,
              const std::string      &place)
        : mesh(mesh)
        , neighbours(neighbours)
        , interface(interface)
        , place(place)
        , edges_of_face(interface.faces.size())
      {
        for (unsigned int f = 0; f < interface.faces.size(); ++f)
          {
            for (const Face &side : interface.faces[f])
              numbers[{side.cell, side.face}] = f;
            const auto v = face_vertices(mesh, interface.faces[f][0]);
            for (const auto &[a, b] : {std::make_pair(0, 1),
                                       std::make_pair(0, 2),
                                       std::make_pair(1, 3),
                                       std::make_pair(2, 3)})
              {
                edges_of_face[f].push_back(std::minmax(v[a], v[b]));
                faces_at_edge[edges_of_face[f].back()].push_back(f);
              }
          }
      }

      /** For each face: which side (0 or 1) corresponds to side 0 of the lowest
       *  face connected to it; and that lowest face. */
      std::vector<std::pair<unsigned int, unsigned int>>
      orient() const
      {
        std::vector<std::pair<unsigned int, unsigned int>> result(
          interface.faces.size(), {none, none});
        for (unsigned int start = 0; start < result.size(); ++start)
          if (result[start].first == none)
            {
              result[start] = {0, start};
              std::vector<unsigned int> front{start};
              while (!front.empty())
                {
                  const unsigned int f = front.back();
                  front.pop_back();
                  for (const Edge &edge : edges_of_face[f])
                    follow(f, edge, result, front);
                }
            }
        return result;
      }

    private:
      using Edge = std::pair<unsigned int, unsigned int>;

      void
      follow(const unsigned int                                  f,
             const Edge                                         &edge,
             std::vector<std::pair<unsigned int, unsigned int>> &result,
             std::vector<unsigned int>                          &front) const
      {
        // where the surface ends, the way around its edge leads to the other
        // side
        if (faces_at_edge.at(edge).size() == 1)
          return;
        if (faces_at_edge.at(edge).size() > 2)
          throw UserError(place + ": the face set \"" + interface.name +
                          "\" branches or crosses itself next to " +
                          describe_face(mesh, interface.faces[f][0]) +
                          "; give each of the surfaces that meet there a set "
                          "of its own.");
        for (const unsigned int side : {0, 1})
          {
            const Face end = walk(interface.faces[f][side], edge);
            if (end.cell == none)
              continue;
            const unsigned int g = numbers.at({end.cell, end.face});
            const unsigned int arrival =
              end.cell == interface.faces[g][0].cell ? 0 : 1;
            // the side of g that corresponds to side 0 of the lowest face
            const unsigned int same =
              side == result[f].first ? arrival : 1 - arrival;
            if (result[g].first == none)
              {
                result[g] = {same, result[f].second};
                front.push_back(g);
              }
            else if (result[g].first != same)
              throw UserError(place + ": the face set \"" + interface.name +
                              "\" has one side only, as a band that is "
                              "twisted once, next to " +
                              describe_face(mesh, interface.faces[f][0]) +
                              "; cut it into two sets.");
          }
      }

      // Walks from a face of the interface, given by one of its cells, around
      // an edge to the next face of the interface; cell `none` if the mesh ends
      // before.
      Face
      walk(Face face, const Edge &edge) const
      {
        while (true)
          {
            // the other face of the cell at this edge
            unsigned int next = none;
            for (unsigned int i = 0; i < 6; ++i)
              if (i != face.face)
                {
                  const auto v = face_vertices(mesh, {face.cell, i});
                  if (std::count(v.begin(), v.end(), edge.first) > 0 &&
                      std::count(v.begin(), v.end(), edge.second) > 0)
                    next = i;
                }
            face.face = next;
            if (numbers.count({face.cell, face.face}) > 0)
              return face;
            face = neighbours[face.cell][face.face];
            if (face.cell == none)
              return face;
          }
      }

      const CoarseMesh                         &mesh;
      const FaceNeighbours                     &neighbours;
      const InterfaceSurface                   &interface;
      const std::string                        &place;
      FaceNumbers                               numbers;
      std::vector<std::vector<Edge>>            edges_of_face;
      std::map<Edge, std::vector<unsigned int>> faces_at_edge;
    };
  } // namespace


  FaceNeighbours
  find_face_neighbours(const CoarseMesh &mesh)
  {
    std::array<Face, 6> outer;
    outer.fill({none, 0});
    FaceNeighbours                neighbours(mesh.cells.size(), outer);
    const std::vector<SortedFace> faces = sorted_faces(mesh);
    for (std::size_t i = 1; i < faces.size(); ++i)
      if (faces[i].vertices == faces[i - 1].vertices)
        {
          const Face &a = faces[i - 1].face, &b = faces[i].face;
          neighbours[a.cell][a.face] = b;
          neighbours[b.cell][b.face] = a;
        }
    return neighbours;
  }


  std::string
  describe_face(const CoarseMesh &mesh, const Face &face)
  {
    Point<3> center;
    for (const unsigned int v : face_vertices(mesh, face))
      center += mesh.vertices[v] / 4.;
    std::ostringstream text;
    text << "the face at (" << center[0] << ", " << center[1] << ", "
         << center[2] << ") m";
    return text.str();
  }


  InterfaceSurface
  make_interface_surface(const CoarseMesh        &mesh,
                         const FaceNeighbours    &neighbours,
                         const std::string       &name,
                         const std::vector<Face> &set,
                         const std::string       &place)
  {
    // at first, side 0 of a face is that of its lower cell
    InterfaceSurface surface;
    surface.name = name;
    FaceNumbers numbers;
    // number of times that each side of a face was named
    std::vector<std::array<int, 2>> named;
    for (const Face &face : set)
      {
        const Face &other = neighbours[face.cell][face.face];
        if (other.cell == none)
          throw UserError(place + ": the face set \"" + name +
                          "\" cannot be an interface, because " +
                          describe_face(mesh, face) +
                          " has no cell on its other side; an interface "
                          "consists of faces inside the mesh.");
        const bool lower             = face.cell < other.cell;
        const auto [entry, is_first] = numbers.insert(
          {{std::min(face.cell, other.cell), lower ? face.face : other.face},
           int(surface.faces.size())});
        if (is_first)
          {
            surface.faces.push_back(
              {{lower ? face : other, lower ? other : face}});
            named.push_back({{0, 0}});
          }
        ++named[entry->second][lower ? 0 : 1];
      }
    if (surface.faces.empty())
      throw UserError(place + ": the face set \"" + name +
                      "\" is empty; an interface needs faces.");

    // The majority in each connected piece; with equal numbers, the face of the
    // lowest number, which was listed first, decides.
    const auto orientation = Surface(mesh, neighbours, surface, place).orient();
    std::vector<int> votes(surface.faces.size(), 0);
    for (unsigned int f = 0; f < votes.size(); ++f)
      votes[orientation[f].second] +=
        named[f][orientation[f].first] - named[f][1 - orientation[f].first];
    for (unsigned int f = 0; f < votes.size(); ++f)
      {
        const unsigned int piece = orientation[f].second;
        const bool         reversed =
          votes[piece] < 0 || (votes[piece] == 0 && named[piece][0] == 0);
        if ((orientation[f].first == 1) != reversed)
          std::swap(surface.faces[f][0], surface.faces[f][1]);
      }
    return surface;
  }
} // namespace Voussoir
