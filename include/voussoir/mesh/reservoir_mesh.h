#ifndef voussoir_mesh_reservoir_mesh_h
#define voussoir_mesh_reservoir_mesh_h

#include <voussoir/mesh/coarse_mesh.h>

namespace Voussoir
{
  /** The face set, in both meshes, of the faces where water meets the rest. */
  inline const std::string wet_wall = "wet wall";

  /**
   * Take the water out of a mesh: the cells of @p cell_sets become a mesh of
   * their own, which is returned, and @p mesh keeps the others. Both have their
   * own vertices at the faces where they met, at the same positions, and these
   * faces make the set `wet_wall` of both. Sets go with their members; a face
   * between water and the rest belongs to its sets on both sides. @p place
   * names the entry with the cell sets. Throws UserError, also where the water
   * leaves a narrow gap to the rest, outside of the @p open_faces (face sets,
   * known or not).
   */
  CoarseMesh
  split_off_reservoir(CoarseMesh                     &mesh,
                      const std::vector<std::string> &cell_sets,
                      const std::string              &place,
                      const std::vector<std::string> &open_faces = {});
} // namespace Voussoir

#endif
