#ifndef voussoir_mesh_sources_ucd_reader_h
#define voussoir_mesh_sources_ucd_reader_h

#include <voussoir/mesh_sources/reader_assembly.h>
#include <voussoir/mesh_sources/reader_file.h>

namespace Voussoir
{
  /**
   * Read an AVS UCD file (ASCII). The material numbers of hexahedra make cell
   * sets "material 3", those of quadrilaterals face sets "boundary 3". Throws
   * UserError. (deal.II's GridIn::read_ucd() refuses quadrilaterals inside the
   * mesh, which name interfaces here, and reports neither line nor remedy for a
   * damaged file; VTK's own reader: see doc/architecture.md.)
   */
  FileMesh
  read_ucd(MeshFile &file);
} // namespace Voussoir

#endif
