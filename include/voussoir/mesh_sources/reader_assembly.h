#ifndef voussoir_mesh_sources_reader_assembly_h
#define voussoir_mesh_sources_reader_assembly_h

#include <voussoir/mesh/coarse_mesh.h>

#include <array>
#include <cstdint>
#include <iosfwd>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace Voussoir
{
  /**
   * Contents of a mesh file of any format: vertices and elements by the
   * numbers the file gives them. Hexahedra and quadrilaterals list their
   * vertices as Gmsh, Abaqus and VTK do (around the bottom, then around the
   * top).
   */
  struct FileMesh
  {
    template <int n>
    struct Element
    {
      std::int64_t                number;
      std::array<std::int64_t, n> vertices;
    };

    std::vector<std::pair<std::int64_t, dealii::Point<3>>> vertices;
    std::vector<Element<8>>                                hexahedra;
    std::vector<Element<4>>                                quadrilaterals;

    /** Elements that the program does not support, by kind ("tetrahedra").
     */
    std::map<std::string, unsigned int> refused;

    /** Elements that are ignored, by kind ("lines"). */
    std::map<std::string, unsigned int> ignored;

    /** Sets by the indices in the vectors above. */
    std::map<std::string, std::vector<unsigned int>> hexahedron_sets;
    std::map<std::string, std::vector<unsigned int>> quadrilateral_sets;

    /** Faces of hexahedra, as deal.II numbers them. */
    std::map<std::string, std::vector<CoarseMesh::Face>> face_sets;

    /** Hexahedra whose free faces, those without a neighbour, make a face set.
     */
    std::map<std::string, std::vector<unsigned int>> free_face_sets;

    /** Sets by the numbers the file gives the vertices. */
    std::map<std::string, std::vector<std::int64_t>> vertex_sets;
  };

  /**
   * The mesh of a file: quadrilaterals become faces of cells, cells numbered in
   * mirror order are turned, vertices without a cell are dropped. Parts of the
   * file that are left out are noted in @p report (may be null), one line each.
   * Throws UserError, with a sentence that begins with the name of the file,
   * for solid elements other than hexahedra with eight vertices and for missing
   * vertices.
   */
  CoarseMesh
  assemble_mesh(const FileMesh    &file,
                const std::string &filename,
                std::ostream      *report);
} // namespace Voussoir

#endif
