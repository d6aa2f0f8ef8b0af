#ifndef voussoir_mesh_sources_gmsh_reader_h
#define voussoir_mesh_sources_gmsh_reader_h

#include <voussoir/mesh_sources/reader_assembly.h>
#include <voussoir/mesh_sources/reader_file.h>

namespace Voussoir
{
  /**
   * Read a Gmsh file of format 2 or 4, ASCII or binary. Physical volumes become
   * cell sets, physical surfaces face sets, physical curves and points vertex
   * sets; a physical group without a name is called "volume 3", "surface 3",
   * "curve 3" or "point 3" after its number. Throws UserError. (Gmsh's library
   * crashes on damaged files, accepts a truncated binary file as a small mesh
   * and reports no line of an error.)
   */
  FileMesh
  read_gmsh(MeshFile &file);
} // namespace Voussoir

#endif
