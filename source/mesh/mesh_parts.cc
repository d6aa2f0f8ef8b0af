#include <voussoir/mesh/interfaces.h>
#include <voussoir/mesh/mesh_geometry.h>
#include <voussoir/mesh/mesh_parts.h>

#include <boost/pending/disjoint_sets.hpp>

#include <set>

namespace Voussoir
{
  std::vector<std::size_t>
  parts_of_cells(const CoarseMesh &mesh)
  {
    boost::disjoint_sets_with_storage<> parts(mesh.cells.size());
    const std::vector<SortedFace>       faces = sorted_faces(mesh);
    for (unsigned int i = 1; i < faces.size(); ++i)
      if (faces[i - 1].vertices == faces[i].vertices)
        parts.union_set(faces[i].face.cell, faces[i - 1].face.cell);
    std::vector<std::size_t> result;
    for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
      result.push_back(parts.find_set(cell));
    return result;
  }


  std::vector<MeshPart>
  find_parts(const CoarseMesh               &mesh,
             const std::vector<std::string> &fixed_sets,
             const std::vector<std::string> &interfaces)
  {
    boost::disjoint_sets_with_storage<> parts(mesh.vertices.size());
    for (const auto &cell : mesh.cells)
      for (const unsigned int vertex : cell)
        parts.union_set(cell[0], vertex);
    for (const std::string &interface : interfaces)
      {
        const auto &first = mesh.face_sets.at(interface),
                   &other = mesh.face_sets.at(interface + other_side);
        for (unsigned int i = 0; i < first.size(); ++i)
          parts.union_set(mesh.cells[first[i].cell][0],
                          mesh.cells[other[i].cell][0]);
      }
    std::set<std::size_t> fixed;
    for (const std::string &set : fixed_sets)
      if (const auto faces = mesh.face_sets.find(set);
          faces != mesh.face_sets.end())
        for (const CoarseMesh::Face &face : faces->second)
          fixed.insert(parts.find_set(mesh.cells[face.cell][0]));

    std::set<std::size_t> seen;
    std::vector<MeshPart> result;
    for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
      if (const std::size_t part = parts.find_set(mesh.cells[cell][0]);
          seen.insert(part).second)
        result.push_back(
          {describe_point(cell_centre(mesh, cell)), fixed.count(part) > 0});
    return result;
  }
} // namespace Voussoir
