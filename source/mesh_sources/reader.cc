#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/mesh/mesh_check.h>
#include <voussoir/mesh_sources/abaqus_reader.h>
#include <voussoir/mesh_sources/gmsh_reader.h>
#include <voussoir/mesh_sources/reader.h>
#include <voussoir/mesh_sources/reader_assembly.h>
#include <voussoir/mesh_sources/reader_file.h>
#include <voussoir/mesh_sources/ucd_reader.h>
#include <voussoir/mesh_sources/vtk_reader.h>

#include <deal.II/base/patterns.h>

#include <filesystem>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Abaqus and AVS UCD share the extension .inp. Abaqus files begin with a
    // keyword or a comment, both with an asterisk; UCD files with a number or
    // a comment after #.
    bool
    is_abaqus(MeshFile &file)
    {
      file.at_end();
      return file.peek_line().substr(0, 1) == "*";
    }


    FileMesh
    read_by_format(MeshFile &file, std::ostream *report)
    {
      const std::string extension =
        lower_case(std::filesystem::path(file.name).extension().string());

      if (extension == ".msh")
        return read_gmsh(file);
      if (extension == ".inp" && is_abaqus(file))
        return read_abaqus(file, report);
      if (extension == ".inp" || extension == ".ucd")
        return read_ucd(file);
      if (extension == ".vtk")
        return read_vtk(file, report);
      if (extension == ".vtu")
        throw UserError(file.name +
                        ": VTU files are not read; save the mesh as VTK legacy "
                        "file (.vtk), for example in ParaView.");
      throw UserError(
        file.name + ": the extension \"" + extension +
        "\" is of no known mesh format; allowed are .msh (Gmsh), .inp (Abaqus "
        "or AVS UCD), .ucd (AVS UCD) and .vtk (VTK legacy).");
    }
  } // namespace


  CoarseMesh
  read_mesh(const std::string &filename, std::ostream *report)
  {
    MeshFile   file(filename);
    CoarseMesh mesh =
      assemble_mesh(read_by_format(file, report), filename, report);
    check_mesh(mesh, filename);
    return mesh;
  }


  void
  MeshReader::declare(ParameterHandler &prm)
  {
    prm.add_parameter(
      "File",
      file,
      "Mesh of hexahedra with eight vertices: Gmsh (.msh, format 2 or 4), "
      "Abaqus (.inp), AVS UCD (.inp or .ucd) or VTK legacy (.vtk). Named sets "
      "are physical groups in Gmsh, ELSET, NSET and SURFACE in Abaqus; the "
      "others call cells \"material 3\" and faces \"boundary 2\" after their "
      "numbers. The path is relative to the folder of the parameter file.",
      Patterns::FileName(Patterns::FileName::input));
    prm.add_parameter("Scale",
                      scale,
                      "Length of the file's unit [m]: 1 for a mesh in metres, "
                      "0.001 in millimetres, 0.3048 in feet.",
                      Patterns::Double(1e-6, 1e6));
  }


  void
  MeshReader::check() const
  {
    if (file.empty())
      throw UserError(
        "\"File\" in section \"Mesh/file\" is empty; give the path of a mesh "
        "file (.msh, .inp, .ucd or .vtk).");
    MeshFile exists(file);
  }


  CoarseMesh
  MeshReader::read(std::ostream *report) const
  {
    CoarseMesh mesh = read_mesh(file, report);
    for (Point<3> &vertex : mesh.vertices)
      vertex *= scale;
    return mesh;
  }
} // namespace Voussoir
