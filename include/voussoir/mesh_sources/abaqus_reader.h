#ifndef voussoir_mesh_sources_abaqus_reader_h
#define voussoir_mesh_sources_abaqus_reader_h

#include <voussoir/mesh_sources/reader_assembly.h>
#include <voussoir/mesh_sources/reader_file.h>

#include <iosfwd>

namespace Voussoir
{
  /**
   * Read an Abaqus input file. ELSETs become cell sets and, where they hold
   * shell or surface elements, face sets; element-based surfaces become face
   * sets, NSETs and node-based surfaces vertex sets. Names keep the letters of
   * their first appearance and, as in Abaqus, are the same in upper and lower
   * case. Sets marked INTERNAL serve to build others and are not kept. Keywords
   * that concern the mesh but are not read go to @p report (may be null).
   * Throws UserError, among others for files with several instances.
   */
  FileMesh
  read_abaqus(MeshFile &file, std::ostream *report);
} // namespace Voussoir

#endif
