#include <voussoir/mesh/gmsh_reader.h>

#include <algorithm>
#include <cstdlib>
#include <map>

namespace Voussoir
{
  namespace
  {
    // Kinds of elements by Gmsh's type number.
    const std::map<int, std::string> refused_types = {
      {4, "tetrahedra"},
      {6, "wedges"},
      {7, "pyramids"},
      {11, "tetrahedra with 10 nodes"},
      {12, "hexahedra with 27 nodes"},
      {13, "wedges with 18 nodes"},
      {14, "pyramids with 14 nodes"},
      {17, "hexahedra with 20 nodes"},
      {18, "wedges with 15 nodes"},
      {19, "pyramids with 13 nodes"}};

    const std::map<int, std::string> ignored_types = {
      {2, "triangles"},
      {9, "triangles with 6 nodes"},
      {8, "lines with 3 nodes"},
      {10, "quadrilaterals with 9 nodes"},
      {16, "quadrilaterals with 8 nodes"}};


    class GmshReader
    {
    public:
      explicit GmshReader(MeshFile &file)
        : file(file)
      {}

      FileMesh
      run()
      {
        read_format();
        while (!file.at_end())
          {
            const std::string section(file.word("a section"));
            const std::string end = "$End" + section.substr(1);
            if (section.front() != '$')
              file.fail("expected a section such as $Nodes, but found \"" +
                        section + "\"; the file is damaged.");
            if (read_section(section))
              file.expect(end);
            else
              while (file.line(end) != end)
                continue;
          }
        return std::move(mesh);
      }

    private:
      using Groups = std::vector<int>;

      // Whether the section concerns us and has been read up to its end.
      bool
      read_section(const std::string &section)
      {
        if (section == "$PhysicalNames")
          read_physical_names();
        else if (section == "$Entities")
          read_entities();
        else if (section == "$Nodes" || section == "$ParametricNodes")
          is_version_2 ? read_nodes_2() : read_nodes_4();
        else if (section == "$Elements")
          is_version_2 ? read_elements_2() : read_elements_4();
        else if (section == "$PartitionedEntities")
          file.fail(
            "the mesh is partitioned; save it in one piece (the program "
            "divides it itself).");
        else
          return false;
        return true;
      }


      void
      read_format()
      {
        if (file.word("$MeshFormat") != "$MeshFormat")
          file.fail("a Gmsh file begins with $MeshFormat; export the mesh from "
                    "Gmsh in format 2.2 or 4.1 (ASCII).");
        const std::string version(file.word("the version"));
        if (file.number<int>("0 for ASCII") != 0)
          file.fail("binary Gmsh files are not read; save as ASCII (in Gmsh: "
                    "File > Export without \"Binary\", or set Mesh.Binary = 0; "
                    "on the command line leave out -bin).");
        is_version_2 = (version == "2" || version.substr(0, 2) == "2.");
        if (!is_version_2 && version != "4.1")
          file.fail("Gmsh format " + version +
                    " is not read; save in format 4.1 or 2.2 (in Gmsh: File > "
                    "Export, or set Mesh.MshFileVersion = 4.1).");
        file.skip_line();
        file.expect("$EndMeshFormat");
      }


      void
      read_physical_names()
      {
        const auto n = file.count("the number of names");
        file.skip_line();
        for (unsigned int i = 0; i < n; ++i)
          {
            std::string_view line      = file.line("a physical name");
            const int        dimension = number<int>(line, "a dimension");
            const int        group     = number<int>(line, "a group number");
            line                       = trimmed(line);
            if (line.size() < 2 || line.front() != '"' || line.back() != '"')
              file.fail("expected a name in quotation marks; the file is "
                        "damaged.");
            names[{dimension, group}] = line.substr(1, line.size() - 2);
          }
      }


      void
      read_entities()
      {
        std::array<unsigned int, 4> n;
        for (unsigned int &n_entities : n)
          n_entities = file.count("a number of entities");
        file.skip_line();
        for (int dimension = 0; dimension < 4; ++dimension)
          for (unsigned int i = 0; i < n[dimension]; ++i)
            {
              std::string_view line = file.line("an entity");
              Groups          &groups =
                groups_of_entity[{dimension,
                                  number<int>(line, "an entity number")}];
              // the position of a point, the bounding box of the others
              for (int c = 0; c < (dimension == 0 ? 3 : 6); ++c)
                number<double>(line, "a coordinate");
              const int n_groups = number<int>(line, "a number of groups");
              // The sign is the orientation of a surface.
              for (int g = 0; g < n_groups; ++g)
                groups.push_back(
                  std::abs(number<int>(line, "a physical group")));
            }
      }


      void
      read_nodes_2()
      {
        const auto n = file.count("the number of nodes");
        for (std::size_t i = 0; i < n; ++i)
          {
            const auto tag = file.number<std::int64_t>("a node number");
            read_vertex(tag);
          }
      }


      void
      read_nodes_4()
      {
        const auto n_blocks = file.count("the number of blocks");
        file.skip_line();
        for (unsigned int block = 0; block < n_blocks; ++block)
          {
            file.number<int>("a dimension");
            file.number<int>("an entity number");
            file.number<int>("0 or 1");
            std::vector<std::int64_t> tags(file.count("the number of nodes"));
            for (std::int64_t &tag : tags)
              tag = file.number<std::int64_t>("a node number");
            for (const std::int64_t tag : tags)
              read_vertex(tag);
          }
      }


      void
      read_vertex(const std::int64_t tag)
      {
        dealii::Point<3> position;
        for (unsigned int d = 0; d < 3; ++d)
          position[d] = file.number<double>("a coordinate");
        file.skip_line(); // parametric coordinates may follow
        mesh.vertices.emplace_back(tag, position);
      }


      void
      read_elements_2()
      {
        const auto n = file.count("the number of elements");
        file.skip_line();
        for (std::size_t i = 0; i < n; ++i)
          {
            std::string_view line = file.line("an element");
            const auto tag  = number<std::int64_t>(line, "an element number");
            const auto type = number<int>(line, "an element type");
            // the physical group, the entity, and of no use here partitions
            const auto n_tags = number<int>(line, "a number of tags");
            Groups     groups;
            for (int t = 0; t < n_tags; ++t)
              {
                const int value = number<int>(line, "a tag");
                if (t == 0 && value != 0)
                  groups.push_back(std::abs(value));
              }
            add_element(tag, type, line, groups);
          }
      }


      void
      read_elements_4()
      {
        const auto n_blocks = file.count("the number of blocks");
        file.skip_line();
        for (unsigned int block = 0; block < n_blocks; ++block)
          {
            const auto dimension = file.number<int>("a dimension");
            const auto entity    = file.number<int>("an entity number");
            const auto type      = file.number<int>("an element type");
            const auto n         = file.count("the number of elements");
            file.skip_line();
            const Groups &groups = groups_of_entity[{dimension, entity}];
            for (std::size_t i = 0; i < n; ++i)
              {
                std::string_view line = file.line("an element");
                const auto       tag =
                  number<std::int64_t>(line, "an element number");
                add_element(tag, type, line, groups);
              }
          }
      }


      void
      add_element(const std::int64_t tag,
                  const int          type,
                  std::string_view   line,
                  const Groups      &groups)
      {
        if (type == 5)
          {
            const auto         vertices = read_vertices<8>(line);
            const unsigned int cell     = find_or_add_cell(tag, vertices);
            for (const int group : groups)
              mesh.hexahedron_sets[group_name(3, group)].push_back(cell);
          }
        else if (type == 3)
          {
            for (const int group : groups)
              mesh.quadrilateral_sets[group_name(2, group)].push_back(
                mesh.quadrilaterals.size());
            mesh.quadrilaterals.push_back({tag, read_vertices<4>(line)});
          }
        else if (type == 1 || type == 15)
          for (const int group : groups)
            {
              auto &set =
                mesh.vertex_sets[group_name(type == 1 ? 1 : 0, group)];
              set.push_back(number<std::int64_t>(line, "a node number"));
              if (type == 1)
                set.push_back(number<std::int64_t>(line, "a node number"));
            }
        else if (refused_types.count(type) > 0)
          ++mesh.refused[refused_types.at(type)];
        else if (ignored_types.count(type) > 0)
          ++mesh.ignored[ignored_types.at(type)];
        else
          ++mesh.refused["elements of Gmsh's type " + std::to_string(type)];
      }


      template <int n>
      std::array<std::int64_t, n>
      read_vertices(std::string_view &line) const
      {
        std::array<std::int64_t, n> vertices;
        for (std::int64_t &vertex : vertices)
          vertex = number<std::int64_t>(line, "a node number");
        return vertices;
      }


      // Format 2.2 writes an element once for each of its physical groups.
      unsigned int
      find_or_add_cell(const std::int64_t                 tag,
                       const std::array<std::int64_t, 8> &vertices)
      {
        if (is_version_2)
          {
            const auto [cell, is_new] =
              cell_of_vertices.emplace(vertices, mesh.hexahedra.size());
            if (!is_new)
              return cell->second;
          }
        mesh.hexahedra.push_back({tag, vertices});
        return mesh.hexahedra.size() - 1;
      }


      std::string
      group_name(const int dimension, const int group) const
      {
        const std::array<std::string, 4> kinds = {
          {"point", "curve", "surface", "volume"}};
        const auto name = names.find({dimension, group});
        return name != names.end() ?
                 name->second :
                 kinds[dimension] + " " + std::to_string(group);
      }


      template <typename Number>
      Number
      number(std::string_view &line, const std::string &expected) const
      {
        return file.to_number<Number>(take_word(line), expected);
      }

      MeshFile &file;
      FileMesh  mesh;
      bool      is_version_2 = false;

      // by dimension and number
      std::map<std::pair<int, int>, std::string> names;
      std::map<std::pair<int, int>, Groups>      groups_of_entity;

      std::map<std::array<std::int64_t, 8>, unsigned int> cell_of_vertices;
    };
  } // namespace


  FileMesh
  read_gmsh(MeshFile &file)
  {
    return GmshReader(file).run();
  }
} // namespace Voussoir
