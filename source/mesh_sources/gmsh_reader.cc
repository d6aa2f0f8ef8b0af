#include <voussoir/mesh_sources/gmsh_reader.h>

#include <algorithm>
#include <cstring>
#include <map>

namespace Voussoir
{
  namespace
  {
    struct ElementType
    {
      int          dimension;
      unsigned int n_nodes;
      std::string  name;
    };

    // Types of elements by Gmsh's numbers.
    const std::map<std::int64_t, ElementType> element_types = {
      {1, {1, 2, "lines"}},
      {2, {2, 3, "triangles"}},
      {3, {2, 4, "quadrilaterals"}},
      {4, {3, 4, "tetrahedra"}},
      {5, {3, 8, "hexahedra"}},
      {6, {3, 6, "wedges"}},
      {7, {3, 5, "pyramids"}},
      {8, {1, 3, "lines with 3 nodes"}},
      {9, {2, 6, "triangles with 6 nodes"}},
      {10, {2, 9, "quadrilaterals with 9 nodes"}},
      {11, {3, 10, "tetrahedra with 10 nodes"}},
      {12, {3, 27, "hexahedra with 27 nodes"}},
      {13, {3, 18, "wedges with 18 nodes"}},
      {14, {3, 14, "pyramids with 14 nodes"}},
      {15, {0, 1, "points"}},
      {16, {2, 8, "quadrilaterals with 8 nodes"}},
      {17, {3, 20, "hexahedra with 20 nodes"}},
      {18, {3, 15, "wedges with 15 nodes"}},
      {19, {3, 13, "pyramids with 13 nodes"}}};


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
          read_section();
        name_sets();
        return std::move(mesh);
      }

    private:
      enum class Format
      {
        version_2,
        version_4_0,
        version_4_1
      };

      // A physical group, by its dimension and number.
      using Group = std::pair<int, std::int64_t>;

      void
      read_format()
      {
        if (file.peek_line() != "$MeshFormat")
          file.fail("a Gmsh file begins with $MeshFormat; export the mesh from "
                    "Gmsh in format 4.1 or 2.2.");
        file.skip_line();
        const std::string version(file.word("the version"));
        if (version == "2" || version.substr(0, 2) == "2.")
          format = Format::version_2;
        else if (version == "4" || version == "4.0")
          format = Format::version_4_0;
        else if (version == "4.1")
          format = Format::version_4_1;
        else
          file.fail("Gmsh format " + in_quotes(version) +
                    " is not read; save in format 4.1 or 2.2 (in Gmsh: File > "
                    "Export, or set Mesh.MshFileVersion = 4.1).");
        is_binary = file.number<int>("0 for ASCII or 1 for binary") != 0;
        if (file.number<int>("the size of numbers") != 8)
          file.fail("numbers of other sizes than 8 bytes are not read; export "
                    "the mesh as ASCII.");
        file.skip_line();
        if (is_binary)
          {
            const std::string_view one = file.bytes(4, "the number 1");
            if (std::count(one.begin(), one.end(), '\0') != 3 ||
                (one.front() != 1 && one.back() != 1))
              file.fail("the file should be binary, as it says one line above, "
                        "but is not; export it again.");
            // whether the byte order of the file differs from that of this
            // machine
            is_swapped = value_of<std::int32_t>(one) != 1;
          }
        file.expect("$EndMeshFormat");
      }


      void
      read_section()
      {
        const std::string section(file.word("a section"));
        if (section.front() != '$')
          file.fail("expected a section such as $Nodes, but found " +
                    in_quotes(section) + "; the file is damaged.");
        const std::string end = "$End" + section.substr(1);
        file.skip_line();
        if (section == "$PartitionedEntities")
          file.fail(
            "the mesh is partitioned; save it in one piece (the program "
            "divides it itself).");
        else if (section == "$PhysicalNames")
          read_names();
        else if (section == "$Entities" && format != Format::version_2)
          read_entities();
        else if (section == "$Nodes" || section == "$ParametricNodes")
          {
            if (format == Format::version_2)
              read_nodes_2(section == "$ParametricNodes");
            else
              read_nodes_4();
          }
        else if (section == "$Elements")
          {
            if (format == Format::version_2)
              read_elements_2();
            else
              read_elements_4();
          }
        else if (!file.go_to(end))
          file.fail("the section " + in_quotes(section) +
                    " has no end; export the file "
                    "again, it is incomplete.");
        file.expect(end);
      }


      // Always ASCII.
      void
      read_names()
      {
        const std::size_t n = file.count("the number of names");
        for (std::size_t i = 0; i < n; ++i)
          {
            const auto dimension        = file.number<int>("a dimension");
            const auto number           = file.number<std::int64_t>("a number");
            const std::string_view name = file.line("a name");
            const std::size_t begin = name.find('"'), last = name.rfind('"');
            if (begin == last)
              file.fail("expected a name in quotation marks; the file is "
                        "damaged.");
            names[{dimension, number}] =
              name.substr(begin + 1, last - begin - 1);
          }
      }


      void
      read_entities()
      {
        std::array<std::size_t, 4> n;
        for (std::size_t &number : n)
          number = count("the number of entities");
        for (int dimension = 0; dimension < 4; ++dimension)
          for (std::size_t i = 0; i < n[dimension]; ++i)
            {
              const auto         entity = integer("an entity");
              const unsigned int extent =
                dimension == 0 && format == Format::version_4_1 ? 3 : 6;
              for (unsigned int k = 0; k < extent; ++k)
                real("a coordinate");
              const std::size_t n_groups = count("the number of groups");
              for (std::size_t k = 0; k < n_groups; ++k)
                // the sign is the orientation
                groups_of_entity[{dimension, entity}].push_back(
                  {dimension, std::abs(integer("a group"))});
              if (dimension > 0)
                {
                  const std::size_t n_bounding = count("a number of entities");
                  for (std::size_t k = 0; k < n_bounding; ++k)
                    integer("an entity");
                }
            }
      }


      void
      read_nodes_2(const bool parametric)
      {
        if (parametric && is_binary)
          file.fail("nodes with parameters are not read; export the mesh "
                    "without them (Mesh.SaveParametric = 0).");
        const std::size_t n = file.count("the number of nodes");
        file.skip_line();
        for (std::size_t i = 0; i < n; ++i)
          {
            const auto number = integer("a node number");
            mesh.vertices.emplace_back(number, position());
            if (parametric)
              file.skip_line();
          }
      }


      void
      read_nodes_4()
      {
        const std::size_t n_blocks = count("the number of blocks");
        count("the number of nodes");
        if (format == Format::version_4_1)
          for (const std::string number : {"the smallest", "the largest"})
            size(number + " node number");
        std::vector<std::int64_t> numbers;
        for (std::size_t block = 0; block < n_blocks; ++block)
          {
            const auto first              = integer("an entity"),
                       second             = integer("an entity");
            const std::int64_t parametric = integer("0 or 1");
            const std::int64_t dimension =
              format == Format::version_4_1 ? first : second;
            const std::size_t  n = count("the number of nodes");
            const unsigned int n_parameters =
              parametric == 0 || dimension < 1 ? 0 :
              format == Format::version_4_1    ? dimension :
              dimension < 3                    ? dimension :
                                                 0;
            numbers.clear();
            for (std::size_t i = 0; i < n && format == Format::version_4_1; ++i)
              numbers.push_back(size("a node number"));
            for (std::size_t i = 0; i < n; ++i)
              {
                const std::int64_t number = format == Format::version_4_1 ?
                                              numbers[i] :
                                              integer("a node number");
                mesh.vertices.emplace_back(number, position());
                for (unsigned int k = 0; k < n_parameters; ++k)
                  real("a parameter");
              }
          }
      }


      void
      read_elements_2()
      {
        std::size_t n_left = file.count("the number of elements");
        file.skip_line();
        while (n_left > 0)
          {
            // binary elements come in blocks of one type
            std::int64_t type, n_tags, number = 0;
            std::size_t  n = 1;
            if (!is_binary)
              number = integer("an element number");
            type = integer("a type of element");
            if (is_binary)
              n = file.check_count(integer("a number of elements"),
                                   "a number of elements");
            n_tags = file.check_count(integer("the number of tags"),
                                      "the number of tags");
            if (n == 0 || n > n_left)
              file.fail("the blocks of elements do not add up to the number "
                        "that the section announces; the file is damaged.");
            for (std::size_t i = 0; i < n; ++i)
              {
                if (is_binary)
                  number = integer("an element number");
                std::int64_t group = 0;
                for (std::int64_t k = 0; k < n_tags; ++k)
                  {
                    const auto tag = integer("a tag");
                    if (k == 0)
                      group = tag;
                  }
                if (group < 0)
                  file.fail("the physical group " + std::to_string(group) +
                            " has a negative number; number the groups from 1 "
                            "on.");
                Groups groups;
                if (group > 0 && element_types.count(type) > 0)
                  groups = {{element_types.at(type).dimension, group}};
                read_element(type, number, groups);
              }
            n_left -= n;
          }
      }


      void
      read_elements_4()
      {
        const std::size_t n_blocks = count("the number of blocks");
        count("the number of elements");
        if (format == Format::version_4_1)
          for (const std::string number : {"the smallest", "the largest"})
            size(number + " element number");
        for (std::size_t block = 0; block < n_blocks; ++block)
          {
            auto dimension = integer("a dimension"),
                 entity    = integer("an entity");
            if (format == Format::version_4_0)
              std::swap(dimension, entity);
            const auto        type = integer("a type of element");
            const std::size_t n    = count("the number of elements");
            const auto        groups =
              groups_of_entity.find({static_cast<int>(dimension), entity});
            for (std::size_t i = 0; i < n; ++i)
              read_element(type,
                           node("an element number"),
                           groups == groups_of_entity.end() ? Groups() :
                                                              groups->second);
          }
      }


      using Groups = std::vector<Group>;

      // Reads an element from its nodes on.
      void
      read_element(const std::int64_t type,
                   const std::int64_t number,
                   const Groups      &groups)
      {
        const auto entry = element_types.find(type);
        if (entry == element_types.end())
          file.fail("elements of Gmsh's type " + std::to_string(type) +
                    " are not read; export elements of first order.");
        const ElementType           &known = entry->second;
        std::array<std::int64_t, 27> nodes;
        for (unsigned int i = 0; i < known.n_nodes; ++i)
          nodes[i] = node("a node number");
        if (type == 5)
          add_hexahedron(number, nodes, groups);
        else if (type == 3)
          {
            for (const Group &group : groups)
              quadrilaterals_of[group].push_back(mesh.quadrilaterals.size());
            mesh.quadrilaterals.push_back({number, {}});
            std::copy_n(nodes.begin(),
                        4,
                        mesh.quadrilaterals.back().vertices.begin());
          }
        else if (type == 1 || type == 15)
          for (const Group &group : groups)
            vertices_of[group].insert(vertices_of[group].end(),
                                      nodes.begin(),
                                      nodes.begin() + known.n_nodes);
        else // other solids are refused later
          ++(known.dimension == 3 ? mesh.refused : mesh.ignored)[known.name];
      }


      // Format 2 repeats an element for each of its groups.
      void
      add_hexahedron(const std::int64_t                  number,
                     const std::array<std::int64_t, 27> &nodes,
                     const Groups                       &groups)
      {
        FileMesh::Element<8> hexahedron{number, {}};
        std::copy_n(nodes.begin(), 8, hexahedron.vertices.begin());
        std::size_t cell = mesh.hexahedra.size();
        if (format == Format::version_2)
          cell =
            cell_of_vertices.emplace(hexahedron.vertices, cell).first->second;
        if (cell == mesh.hexahedra.size())
          mesh.hexahedra.push_back(hexahedron);
        for (const Group &group : groups)
          hexahedra_of[group].push_back(cell);
      }


      // Names may come after the elements.
      void
      name_sets()
      {
        const auto add = [&](auto &sets, const auto &members_of) {
          for (const auto &[group, members] : members_of)
            {
              auto &set = sets[name_of(group)];
              set.insert(set.end(), members.begin(), members.end());
            }
        };
        add(mesh.hexahedron_sets, hexahedra_of);
        add(mesh.quadrilateral_sets, quadrilaterals_of);
        add(mesh.vertex_sets, vertices_of);
      }


      std::string
      name_of(const Group &group) const
      {
        const std::array<std::string, 4> kinds = {
          {"point", "curve", "surface", "volume"}};
        const auto name = names.find(group);
        return name != names.end() && !name->second.empty() ?
                 name->second :
                 kinds[group.first] + " " + std::to_string(group.second);
      }


      template <typename Number>
      Number
      value_of(const std::string_view bytes) const
      {
        std::array<char, sizeof(Number)> ordered;
        std::copy(bytes.begin(), bytes.end(), ordered.begin());
        if (is_swapped)
          std::reverse(ordered.begin(), ordered.end());
        Number value;
        std::memcpy(&value, ordered.data(), sizeof(Number));
        return value;
      }


      // The next number: ASCII, or binary of the type Stored.
      template <typename Stored, typename Number>
      Number
      read(const std::string &expected)
      {
        if (is_binary)
          return value_of<Stored>(file.bytes(sizeof(Stored), expected));
        return file.number<Number>(expected);
      }

      std::int64_t
      integer(const std::string &expected)
      {
        return read<std::int32_t, std::int64_t>(expected);
      }

      std::int64_t
      size(const std::string &expected)
      {
        return read<std::int64_t, std::int64_t>(expected);
      }

      std::size_t
      count(const std::string &expected)
      {
        return file.check_count(size(expected), expected);
      }

      /** The number of a node or an element. */
      std::int64_t
      node(const std::string &expected)
      {
        return format == Format::version_4_1 ? size(expected) :
                                               integer(expected);
      }

      double
      real(const std::string &expected)
      {
        return read<double, double>(expected);
      }

      dealii::Point<3>
      position()
      {
        dealii::Point<3> result;
        for (unsigned int d = 0; d < 3; ++d)
          result[d] = file.check_coordinate(real("a coordinate"));
        return result;
      }

      MeshFile &file;
      Format    format    = Format::version_4_1;
      bool      is_binary = false, is_swapped = false;
      FileMesh  mesh;

      std::map<Group, std::string>               names;
      std::map<Group, Groups>                    groups_of_entity;
      std::map<Group, std::vector<unsigned int>> hexahedra_of,
        quadrilaterals_of;
      std::map<Group, std::vector<std::int64_t>>         vertices_of;
      std::map<std::array<std::int64_t, 8>, std::size_t> cell_of_vertices;
    };
  } // namespace


  FileMesh
  read_gmsh(MeshFile &file)
  {
    return GmshReader(file).run();
  }
} // namespace Voussoir
