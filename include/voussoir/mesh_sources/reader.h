#ifndef voussoir_mesh_sources_reader_h
#define voussoir_mesh_sources_reader_h

#include <voussoir/mesh/coarse_mesh.h>

#include <deal.II/base/parameter_handler.h>

#include <iosfwd>
#include <string>

namespace Voussoir
{
  /**
   * Read a mesh of hexahedra with its named sets from a Gmsh (.msh), Abaqus
   * (.inp), AVS UCD (.ucd or .inp) or VTK legacy (.vtk) file. Parts of the file
   * that are not read are noted in @p report (may be null), one line each. The
   * mesh has passed check_mesh(). Lengths are those of the file. Throws
   * UserError.
   */
  CoarseMesh
  read_mesh(const std::string &filename, std::ostream *report);

  /** The parameter section of a mesh that is read from a file. */
  struct MeshReader
  {
    std::string file;
    double      scale = 1.;

    void
    declare(dealii::ParameterHandler &prm);

    void
    check() const;

    /** The mesh of the file, in metres. */
    CoarseMesh
    read(std::ostream *report) const;
  };
} // namespace Voussoir

#endif
