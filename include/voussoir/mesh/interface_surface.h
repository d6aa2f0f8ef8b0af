#ifndef voussoir_mesh_interface_surface_h
#define voussoir_mesh_interface_surface_h

#include <voussoir/mesh/coarse_mesh.h>

#include <deal.II/base/numbers.h>

namespace Voussoir
{
  /** For each face of each cell the neighbour and its number of the face; cell
   *  `invalid_unsigned_int` at the mesh's surface. */
  using FaceNeighbours = std::vector<std::array<CoarseMesh::Face, 6>>;

  FaceNeighbours
  find_face_neighbours(const CoarseMesh &mesh);

  /** Faces inside a mesh with their two sides, the first side first. */
  struct InterfaceSurface
  {
    std::string                                  name;
    std::vector<std::array<CoarseMesh::Face, 2>> faces;
  };

  /**
   * The surface of a face set, each face once. The first side is the side from
   * which the set names its faces, in each connected piece by their majority;
   * @p place names the entry with the set. Throws UserError if the set is
   * empty, has outer faces, branches or has only one side.
   */
  InterfaceSurface
  make_interface_surface(const CoarseMesh                    &mesh,
                         const FaceNeighbours                &neighbours,
                         const std::string                   &name,
                         const std::vector<CoarseMesh::Face> &set,
                         const std::string                   &place);

  /** "the face at (x, y, z) m", with its centre. */
  std::string
  describe_face(const CoarseMesh &mesh, const CoarseMesh::Face &face);
} // namespace Voussoir

#endif
