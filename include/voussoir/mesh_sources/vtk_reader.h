#ifndef voussoir_mesh_sources_vtk_reader_h
#define voussoir_mesh_sources_vtk_reader_h

#include <voussoir/mesh_sources/reader_assembly.h>
#include <voussoir/mesh_sources/reader_file.h>

#include <iosfwd>

namespace Voussoir
{
  /**
   * Read a VTK legacy file (ASCII or binary, versions 1 to 5) with an
   * unstructured grid. One cell data array gives the sets, the first of
   * MaterialID, MaterialIDs, Material, BlockID, Block, CellEntityIDs and
   * Region, whatever their case and signs such as _: its numbers make cell sets
   * "material 3" of the hexahedra and face sets "boundary 3" of the
   * quadrilaterals. Without such an array there are no sets, and @p report
   * (may be null) notes it. Throws UserError. (deal.II's GridIn::read_vtk()
   * reads neither binary files nor version 5, accepts one name of the array
   * only and refuses quadrilaterals inside the mesh, which name interfaces
   * here; VTK's own reader: see doc/architecture.md.)
   */
  FileMesh
  read_vtk(MeshFile &file, std::ostream *report);
} // namespace Voussoir

#endif
