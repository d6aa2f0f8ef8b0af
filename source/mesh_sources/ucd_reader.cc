#include <voussoir/mesh_sources/ucd_reader.h>

#include <map>

namespace Voussoir
{
  namespace
  {
    const std::map<std::string_view, std::string> refused_ucd_types =
      {{"tet", "tetrahedra"}, {"pyr", "pyramids"}, {"prism", "wedges"}};

    const std::map<std::string_view, std::string> ignored_ucd_types =
      {{"pt", "points"}, {"line", "lines"}, {"tri", "triangles"}};


    // UCD gives the top of a hexahedron before its bottom.
    constexpr std::array<unsigned int, 8> bottom_first = {
      {4, 5, 6, 7, 0, 1, 2, 3}};
  } // namespace


  FileMesh
  read_ucd(MeshFile &file)
  {
    while (!file.at_end() && file.peek_line().front() == '#')
      file.skip_line();

    const auto n_nodes = file.count("the number of nodes");
    const auto n_cells = file.count("the number of cells");
    file.skip_line(); // the numbers of data

    FileMesh mesh;
    for (std::size_t i = 0; i < n_nodes; ++i)
      {
        const auto       number = file.number<std::int64_t>("a node number");
        dealii::Point<3> position;
        for (unsigned int d = 0; d < 3; ++d)
          position[d] = file.coordinate();
        mesh.vertices.emplace_back(number, position);
      }

    for (std::size_t i = 0; i < n_cells; ++i)
      {
        const auto number   = file.number<std::int64_t>("a cell number");
        const auto material = std::to_string(file.number<int>("a material"));
        const std::string_view type = file.word("a type of cell");
        if (type == "hex")
          {
            FileMesh::Element<8> hexahedron{number, {}};
            for (const unsigned int v : bottom_first)
              hexahedron.vertices[v] =
                file.number<std::int64_t>("a node number");
            mesh.hexahedron_sets["material " + material].push_back(
              mesh.hexahedra.size());
            mesh.hexahedra.push_back(hexahedron);
          }
        else if (type == "quad")
          {
            FileMesh::Element<4> quadrilateral{number, {}};
            for (std::int64_t &vertex : quadrilateral.vertices)
              vertex = file.number<std::int64_t>("a node number");
            mesh.quadrilateral_sets["boundary " + material].push_back(
              mesh.quadrilaterals.size());
            mesh.quadrilaterals.push_back(quadrilateral);
          }
        else
          {
            if (refused_ucd_types.count(type) > 0)
              ++mesh.refused[refused_ucd_types.at(type)];
            else if (ignored_ucd_types.count(type) > 0)
              ++mesh.ignored[ignored_ucd_types.at(type)];
            else
              file.fail("unknown type of cell " + in_quotes(type) +
                        "; allowed are hex and quad (line, tri and pt are "
                        "left out).");
            file.skip_line();
          }
      }
    return mesh;
  }
} // namespace Voussoir
