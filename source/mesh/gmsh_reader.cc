#include <voussoir/base/error.h>
#include <voussoir/mesh/gmsh_reader.h>

#include <gmsh.h>

#include <algorithm>
#include <cstdlib>
#include <map>

namespace Voussoir
{
  namespace
  {
    // What Gmsh calls the shapes of elements.
    const std::map<std::string, std::string> shapes = {
      {"Line", "lines"},
      {"Triangle", "triangles"},
      {"Quadrilateral", "quadrilaterals"},
      {"Tetrahedron", "tetrahedra"},
      {"Prism", "wedges"},
      {"Pyramid", "pyramids"},
      {"Hexahedron", "hexahedra"}};


    /**
     * Looks through a file before Gmsh's library reads it, which takes a
     * shortened binary file for a small mesh, leaves out elements beyond their
     * number and says of no error in which line it is.
     */
    class GmshFileCheck
    {
    public:
      explicit GmshFileCheck(MeshFile &file)
        : file(file)
      {}

      /** Whether the format is 2.0, 2.1 or 2.2, and not 4.0 or 4.1. */
      bool
      run()
      {
        check_format();
        if (file.go_to("$PartitionedEntities"))
          file.fail(
            "the mesh is partitioned; save it in one piece (the program "
            "divides it itself).");
        if (is_binary)
          {
            for (const std::string end : {"$EndNodes", "$EndElements"})
              if (!file.go_to(end))
                file.fail("the file ends before " + end +
                          "; export it again, it is incomplete.");
          }
        else
          while (!file.at_end())
            check_section();
        return is_version_2;
      }

    private:
      void
      check_format()
      {
        // Gmsh would run anything else as a script
        if (file.peek_line() != "$MeshFormat")
          file.fail("a Gmsh file begins with $MeshFormat; export the mesh from "
                    "Gmsh in format 4.1 or 2.2.");
        file.skip_line();
        const std::string version(file.word("the version"));
        is_version_2 = (version == "2" || version.substr(0, 2) == "2.");
        if (!is_version_2 && version.substr(0, 1) != "4")
          file.fail("Gmsh format " + version +
                    " is not read; save in format 4.1 or 2.2 (in Gmsh: File > "
                    "Export, or set Mesh.MshFileVersion = 4.1).");
        is_binary = file.number<int>("0 for ASCII or 1 for binary") != 0;
        file.skip_line();
        if (is_binary)
          {
            // in either order of bytes
            const std::string_view one = file.bytes(4, "the number 1");
            if (std::count(one.begin(), one.end(), '\0') != 3 ||
                (one.front() != 1 && one.back() != 1))
              file.fail("the file should be binary, as it says one line above, "
                        "but is not; export it again.");
          }
        file.expect("$EndMeshFormat");
      }


      void
      check_section()
      {
        const std::string section(file.word("a section"));
        const std::string end = "$End" + section.substr(1);
        if (section.front() != '$')
          file.fail("expected a section such as $Nodes, but found \"" +
                    section + "\"; the file is damaged.");
        if (section == "$Nodes" || section == "$ParametricNodes")
          for (auto word = file.word(end); word != end; word = file.word(end))
            file.to_number<double>(word, "a number");
        else if (section == "$Elements")
          {
            check_elements();
            file.expect(end);
          }
        else
          while (file.line(end) != end)
            continue;
      }


      // One line each, in format 4 also for each block.
      void
      check_elements()
      {
        std::size_t n = is_version_2 ? 0 : file.count("the number of blocks");
        n += file.count("the number of elements");
        file.skip_line();
        for (std::size_t i = 0; i < n; ++i)
          {
            std::string_view line = file.line("an element");
            do
              file.to_number<double>(take_word(line), "a number");
            while (!line.empty());
          }
      }

      MeshFile &file;
      bool      is_version_2 = false, is_binary = false;
    };


    /** Gmsh's library, which has one state for the whole program. */
    class GmshLibrary
    {
    public:
      explicit GmshLibrary(const bool is_version_2)
      {
        gmsh::initialize(0, nullptr, false);
        gmsh::option::setNumber("General.Terminal", 0);
        // Gmsh knows groups of entities, but other programs write in format 2
        // one entity with elements of several groups. So let each group be an
        // entity.
        gmsh::option::setNumber("Mesh.SwitchElementTags", is_version_2);
      }

      GmshLibrary(const GmshLibrary &) = delete;

      ~GmshLibrary()
      {
        gmsh::finalize();
      }

      void
      open(const std::string &filename) const
      {
        try
          {
            gmsh::merge(filename);
          }
        catch (...) // a string before Gmsh 4.9, then an exception
          {
            std::string problem;
            gmsh::logger::getLastError(problem);
            throw UserError(filename +
                            ": Gmsh's library cannot read the file "
                            "(\"" +
                            problem +
                            "\"); it is damaged, so export nodes and elements "
                            "together once more.");
          }
      }
    };


    class GmshReader
    {
    public:
      GmshReader(const std::string &filename, const bool is_version_2)
        : filename(filename)
        , is_version_2(is_version_2)
        , library(is_version_2)
      {}

      FileMesh
      run()
      {
        library.open(filename);
        read_nodes();
        gmsh::vectorpair entities;
        gmsh::model::getEntities(entities);
        for (const auto &[dimension, entity] : entities)
          read_entity(dimension, entity);
        number_hexahedra();
        return std::move(mesh);
      }

    private:
      using Groups = std::vector<std::string>;

      void
      read_nodes()
      {
        std::vector<std::size_t> numbers;
        std::vector<double>      coordinates, parametric;
        gmsh::model::mesh::getNodes(numbers, coordinates, parametric);
        for (std::size_t i = 0; i < numbers.size(); ++i)
          mesh.vertices.emplace_back(numbers[i],
                                     dealii::Point<3>(coordinates[3 * i],
                                                      coordinates[3 * i + 1],
                                                      coordinates[3 * i + 2]));
      }


      void
      read_entity(const int dimension, const int entity)
      {
        if (entity < 0)
          throw UserError(filename + ": the physical group " +
                          std::to_string(entity) +
                          " has a negative number; number the groups from 1 "
                          "on.");
        groups.push_back(groups_of(dimension, entity));
        std::vector<int>                      types;
        std::vector<std::vector<std::size_t>> numbers, nodes;
        gmsh::model::mesh::getElements(
          types, numbers, nodes, dimension, entity);
        for (std::size_t i = 0; i < types.size(); ++i)
          add_elements(types[i], numbers[i], nodes[i]);
      }


      Groups
      groups_of(const int dimension, const int entity) const
      {
        std::vector<int> group_numbers;
        if (!is_version_2)
          gmsh::model::getPhysicalGroupsForEntity(dimension,
                                                  entity,
                                                  group_numbers);
        else if (entity != 0)
          group_numbers = {entity};

        const std::array<std::string, 4> kinds = {
          {"point", "curve", "surface", "volume"}};
        Groups result;
        for (const int signed_number : group_numbers)
          {
            // the sign is the orientation of a surface
            const int   number = std::abs(signed_number);
            std::string name;
            gmsh::model::getPhysicalName(dimension, number, name);
            result.push_back(name.empty() ?
                               kinds[dimension] + " " + std::to_string(number) :
                               name);
          }
        return result;
      }


      // Of the entity that was read last.
      void
      add_elements(const int                       type,
                   const std::vector<std::size_t> &numbers,
                   const std::vector<std::size_t> &nodes)
      {
        if (type == 5)
          for (std::size_t i = 0; i < numbers.size(); ++i)
            hexahedra.push_back(
              {element<8>(numbers, nodes, i), groups.size() - 1});
        else if (type == 3)
          for (std::size_t i = 0; i < numbers.size(); ++i)
            {
              for (const std::string &group : groups.back())
                mesh.quadrilateral_sets[group].push_back(
                  mesh.quadrilaterals.size());
              mesh.quadrilaterals.push_back(element<4>(numbers, nodes, i));
            }
        else if (type == 1 || type == 15) // lines and points
          for (const std::string &group : groups.back())
            mesh.vertex_sets[group].insert(mesh.vertex_sets[group].end(),
                                           nodes.begin(),
                                           nodes.end());
        else
          leave_out(type, numbers.size());
      }


      // Other solids are refused later, lines and surfaces are of no use.
      void
      leave_out(const int type, const std::size_t n)
      {
        std::string         name;
        int                 dimension, order, n_nodes, n_corners;
        std::vector<double> positions;
        gmsh::model::mesh::getElementProperties(
          type, name, dimension, order, n_nodes, positions, n_corners);
        const auto  shape = shapes.find(name.substr(0, name.find(' ')));
        std::string kind  = shape != shapes.end() ?
                              shape->second :
                              "elements of Gmsh's type " + std::to_string(type);
        if (order > 1)
          kind += " with " + std::to_string(n_nodes) + " nodes";
        (dimension == 3 ? mesh.refused : mesh.ignored)[kind] += n;
      }


      template <int n>
      static FileMesh::Element<n>
      element(const std::vector<std::size_t> &numbers,
              const std::vector<std::size_t> &nodes,
              const std::size_t               i)
      {
        FileMesh::Element<n> result;
        result.number = numbers[i];
        std::copy_n(nodes.begin() + n * i, n, result.vertices.begin());
        return result;
      }


      // In the file's order, not that of the entities. Format 2 gives an
      // element once for each of its groups.
      void
      number_hexahedra()
      {
        std::stable_sort(hexahedra.begin(),
                         hexahedra.end(),
                         [](const auto &a, const auto &b) {
                           return a.first.number < b.first.number;
                         });
        std::map<std::array<std::int64_t, 8>, unsigned int> cell_of_vertices;
        for (const auto &[hexahedron, entity] : hexahedra)
          {
            unsigned int cell = mesh.hexahedra.size();
            if (is_version_2)
              cell = cell_of_vertices.emplace(hexahedron.vertices, cell)
                       .first->second;
            if (cell == mesh.hexahedra.size())
              mesh.hexahedra.push_back(hexahedron);
            for (const std::string &group : groups[entity])
              mesh.hexahedron_sets[group].push_back(cell);
          }
      }

      const std::string &filename;
      const bool         is_version_2;
      const GmshLibrary  library;
      FileMesh           mesh;

      // Names of the groups of each entity; hexahedra with their entities.
      std::vector<Groups>                                       groups;
      std::vector<std::pair<FileMesh::Element<8>, std::size_t>> hexahedra;
    };
  } // namespace


  FileMesh
  read_gmsh(MeshFile &file)
  {
    const bool is_version_2 = GmshFileCheck(file).run();
    return GmshReader(file.name, is_version_2).run();
  }
} // namespace Voussoir
