#ifndef voussoir_mesh_interfaces_h
#define voussoir_mesh_interfaces_h

#include <voussoir/mesh/coarse_mesh.h>

namespace Voussoir
{
  /** Suffix of the name of the face set of an interface's second side. */
  inline const std::string other_side = " (other side)";

  /**
   * The faces where a cell of @p cell_set meets one of @p other_cell_set, named
   * from the side of @p cell_set. @p place names where the names were read.
   * Throws UserError if there are none or the two sets share cells.
   */
  std::vector<CoarseMesh::Face>
  faces_between(const CoarseMesh  &mesh,
                const std::string &cell_set,
                const std::string &other_cell_set,
                const std::string &place);

  /**
   * Open the mesh along sets of inner faces: cells on different sides of them
   * get vertices of their own at the same positions. Where an interface ends
   * inside the body the two sides stay connected, as at the tip of a crack.
   *
   * The set "NAME" then holds the faces of the first side, from which the set
   * names its faces, in each connected surface by their majority; "NAME" +
   * `other_side` holds the faces of the second side. Other sets keep their
   * members; copies of a vertex belong to its sets.
   *
   * All interfaces of a mesh go into one call. @p place names the entry with
   * the sets. Throws UserError if a set is unknown or empty, has outer faces,
   * faces of another of the sets, branches or only one side, or has a face that
   * cannot open because all its vertices lie at the tip.
   */
  void
  split_interfaces(CoarseMesh                     &mesh,
                   const std::vector<std::string> &face_sets,
                   const std::string              &place);
} // namespace Voussoir

#endif
