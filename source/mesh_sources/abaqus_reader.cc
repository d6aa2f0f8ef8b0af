#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/mesh_sources/abaqus_reader.h>
#include <voussoir/mesh_sources/abaqus_sets.h>

#include <algorithm>
#include <map>
#include <ostream>
#include <set>
#include <unordered_map>

namespace Voussoir
{
  namespace
  {
    using Numbers = AbaqusSets::Numbers;

    // Solid elements that are no trilinear hexahedra, by the beginning of their
    // type; other elements are ignored (beams, masses, ...).
    const std::vector<std::pair<std::string, std::string>>
      refused_abaqus_types = {{"C3D4", "tetrahedra"},
                              {"C3D5", "pyramids"},
                              {"C3D6", "wedges"},
                              {"C3D10", "tetrahedra with 10 nodes"},
                              {"C3D15", "wedges with 15 nodes"},
                              {"C3D20", "hexahedra with 20 nodes"},
                              {"C3D27", "hexahedra with 27 nodes"},
                              {"C3D", "solid elements"},
                              {"AC3D", "acoustic elements"},
                              {"DC3D", "heat transfer elements"},
                              {"COH3D", "cohesive elements"},
                              {"CIN3D", "infinite elements"},
                              {"SC6", "continuum shells"},
                              {"SC8", "continuum shells"},
                              {"CSS8", "continuum shells"}};

    const std::vector<std::string> quadrilateral_types =
      {"S4", "R3D4", "M3D4", "SFM3D4", "CPS4", "CPE4"};

    // Keywords that generate nodes or elements.
    const std::vector<std::string> refused_keywords = {"NGEN",
                                                       "NFILL",
                                                       "NCOPY",
                                                       "NMAP",
                                                       "ELGEN",
                                                       "ELCOPY",
                                                       "SYSTEM",
                                                       "INCLUDE"};

    // Abaqus's faces S1 to S6 in deal.II's numbers.
    constexpr std::array<unsigned int, 6> face_of_side = {{4, 5, 2, 1, 3, 0}};


    bool
    begins_with(const std::string_view text, const std::string_view beginning)
    {
      return text.substr(0, beginning.size()) == beginning;
    }


    class AbaqusReader
    {
    public:
      AbaqusReader(MeshFile &file, std::ostream *report)
        : file(file)
        , report(report)
        , element_sets(file, "ELSET")
        , node_sets(file, "NSET")
        , surfaces(file, "NAME")
      {}

      FileMesh
      run()
      {
        while (!file.at_end())
          if (find_data_line(file))
            file.skip_line();
          else if (!file.at_end())
            read_keyword();
        name_sets();
        return std::move(mesh);
      }

    private:
      void
      read_keyword()
      {
        std::string line(file.line("a keyword"));
        while (line.back() == ',' && !file.at_end())
          line += file.line("a keyword");
        const AbaqusKeyword keyword(line);

        if (keyword.name == "NODE")
          read_nodes(keyword);
        else if (keyword.name == "ELEMENT")
          read_elements(keyword);
        else if (keyword.name == "ELSET")
          element_sets.add(keyword,
                           element_sets.read_members(keyword, is_ours(keyword)),
                           is_in_assembly);
        else if (keyword.name == "NSET")
          read_node_set(keyword);
        else if (keyword.name == "SURFACE")
          read_surface(keyword);
        else if (keyword.name == "PART" || keyword.name == "INSTANCE")
          read_part(keyword);
        else if (keyword.name == "ASSEMBLY" || keyword.name == "END INSTANCE")
          is_in_assembly = true;
        else if (keyword.name == "END ASSEMBLY")
          is_in_assembly = false;
        else if (keyword.name == "TIE")
          note("*TIE is not read, tied surfaces stay separate");
        else if (std::count(refused_keywords.begin(),
                            refused_keywords.end(),
                            keyword.name) > 0)
          file.fail("*" + keyword.name +
                    " is not read; write all nodes and elements out into one "
                    "file, in Cartesian coordinates.");
      }


      // Numbers of nodes and elements start anew in each part. The part or its
      // instance has them, depending on which was meshed.
      void
      read_part(const AbaqusKeyword &keyword)
      {
        if (!parts.insert(keyword.name).second || find_data_line(file))
          file.fail("several parts or instances, or an instance that is moved, "
                    "are not read; write a flat file (in Abaqus/CAE: Model > "
                    "Edit Attributes > \"Do not use parts and assemblies in "
                    "input files\").");
        is_in_assembly = false;
      }


      void
      refuse_included_file(const AbaqusKeyword &keyword) const
      {
        if (keyword.has("INPUT"))
          file.fail("*" + keyword.name +
                    " takes its data from another file; write all nodes and "
                    "elements out into one file.");
      }


      void
      read_nodes(const AbaqusKeyword &keyword)
      {
        refuse_included_file(keyword);
        if (keyword.has("SYSTEM") && upper_case(keyword["SYSTEM"]) != "R")
          file.fail("nodes in cylindrical or spherical coordinates are not "
                    "read; write them in Cartesian coordinates.");
        Numbers numbers;
        while (find_data_line(file))
          {
            const auto items = split_at_commas(file.line("a node"));
            // Reference points of the assembly have numbers of their own.
            if (is_in_assembly)
              continue;
            if (items.size() < 3)
              file.fail("expected a node number and three coordinates, divided "
                        "by commas.");
            dealii::Point<3> position;
            for (unsigned int d = 0; d < 3 && d + 1 < items.size(); ++d)
              position[d] = file.check_coordinate(
                file.to_number<double>(items[d + 1], "a coordinate"));
            numbers.push_back(
              file.to_number<std::int64_t>(items[0], "a node number"));
            mesh.vertices.emplace_back(numbers.back(), position);
          }
        if (keyword.has("NSET"))
          node_sets.add(keyword, numbers, is_in_assembly);
      }


      void
      read_elements(const AbaqusKeyword &keyword)
      {
        refuse_included_file(keyword);
        const std::string type = upper_case(keyword["TYPE"]);
        if (type.empty())
          file.fail("*ELEMENT without TYPE; add for example TYPE=C3D8.");
        const auto is_beginning_of_type = [&](const std::string &beginning) {
          return begins_with(type, beginning);
        };
        const bool is_hexahedron    = begins_with(type, "C3D8");
        const bool is_quadrilateral = std::any_of(quadrilateral_types.begin(),
                                                  quadrilateral_types.end(),
                                                  is_beginning_of_type);
        Numbers    numbers;
        while (find_data_line(file))
          {
            const Numbers element = read_element(is_hexahedron    ? 8 :
                                                 is_quadrilateral ? 4 :
                                                                    0);
            numbers.push_back(element[0]);
            if (is_hexahedron)
              add_element(element, hexahedra, mesh.hexahedra);
            else if (is_quadrilateral)
              add_element(element, quadrilaterals, mesh.quadrilaterals);
            else
              {
                count_other_element(type);
                others.insert(element[0]);
              }
          }
        if (keyword.has("ELSET"))
          element_sets.add(keyword, numbers, is_in_assembly);
      }


      // The element's number and its nodes (0: not known how many). An element
      // continues in the next line while nodes are missing or after a comma.
      Numbers
      read_element(const unsigned int n_nodes)
      {
        Numbers element;
        bool    is_continued = true;
        while (is_continued)
          {
            if (!find_data_line(file))
              file.fail("the element ends after " +
                        counted(element.size(), "number", "numbers") +
                        "; export it again, it is incomplete.");
            const std::string_view line = file.line("an element");
            for (const std::string_view item : split_at_commas(line))
              element.push_back(
                file.to_number<std::int64_t>(item, "an integer number"));
            is_continued =
              (n_nodes > 0 ? element.size() < n_nodes + 1 : line.back() == ',');
          }
        return element;
      }


      template <int n>
      void
      add_element(const Numbers                                  &numbers,
                  std::unordered_map<std::int64_t, unsigned int> &index_of,
                  std::vector<FileMesh::Element<n>>              &elements)
      {
        if (numbers.size() != n + 1)
          file.fail("expected an element number and " + std::to_string(n) +
                    " nodes, but found " + std::to_string(numbers.size()) +
                    " numbers.");
        if (hexahedra.count(numbers[0]) + quadrilaterals.count(numbers[0]) > 0)
          file.fail("element " + std::to_string(numbers[0]) +
                    " is given twice; number the elements anew and export "
                    "again.");
        index_of[numbers[0]] = elements.size();
        elements.push_back({numbers[0], {}});
        std::copy_n(numbers.begin() + 1, n, elements.back().vertices.begin());
      }


      void
      count_other_element(const std::string &type)
      {
        for (const auto &[beginning, kind] : refused_abaqus_types)
          if (begins_with(type, beginning))
            {
              ++mesh.refused[kind + " (" + type + ")"];
              return;
            }
        ++mesh.ignored["elements of type " + type];
      }


      // Whether numbers without an instance are those of the mesh; in the
      // assembly they are those of its reference points.
      bool
      is_ours(const AbaqusKeyword &keyword) const
      {
        return !is_in_assembly || keyword.has("INSTANCE");
      }


      void
      read_node_set(const AbaqusKeyword &keyword)
      {
        Numbers numbers = node_sets.read_members(keyword, is_ours(keyword));
        if (keyword.has("ELSET"))
          for (const auto number :
               element_sets.members_of(keyword["ELSET"], true))
            add_nodes_of_element(number, numbers);
        node_sets.add(keyword, numbers, is_in_assembly);
      }


      void
      add_nodes_of_element(const std::int64_t number, Numbers &nodes) const
      {
        const auto add = [&](const auto &index_of, const auto &elements) {
          const auto entry = index_of.find(number);
          if (entry != index_of.end())
            nodes.insert(nodes.end(),
                         elements[entry->second].vertices.begin(),
                         elements[entry->second].vertices.end());
        };
        add(hexahedra, mesh.hexahedra);
        add(quadrilaterals, mesh.quadrilaterals);
      }


      void
      read_surface(const AbaqusKeyword &keyword)
      {
        const std::string type = upper_case(keyword["TYPE"]);
        if (!type.empty() && type != "ELEMENT" && type != "NODE")
          {
            note("*SURFACE, TYPE=" + type + " is not read");
            return;
          }

        const std::string name = surfaces.add(keyword, {}, is_in_assembly).name;
        unsigned int      n_unknown = 0;
        while (find_data_line(file))
          {
            const auto items = split_at_commas(file.line("a surface"));
            if (type == "NODE")
              for (const auto number :
                   node_sets.members_of(items[0], !is_in_assembly))
                mesh.vertex_sets[name].push_back(number);
            else
              for (const auto number :
                   element_sets.members_of(items[0], !is_in_assembly))
                n_unknown +=
                  !add_side(name,
                            number,
                            items.size() > 1 ? upper_case(items[1]) : "");
          }
        note_unknown(name, n_unknown);
      }


      // Whether the element of this number has been read.
      bool
      add_side(const std::string &name,
               const std::int64_t number,
               const std::string &side)
      {
        const auto hexahedron    = hexahedra.find(number);
        const auto quadrilateral = quadrilaterals.find(number);
        if (quadrilateral != quadrilaterals.end())
          mesh.quadrilateral_sets[name].push_back(quadrilateral->second);
        else if (hexahedron == hexahedra.end())
          {
            refuse_missing(name, number);
            return false;
          }
        else if (side.empty())
          mesh.free_face_sets[name].push_back(hexahedron->second);
        else if (side.size() == 2 && side[0] == 'S' && side[1] >= '1' &&
                 side[1] <= '6')
          mesh.face_sets[name].push_back(
            {hexahedron->second, face_of_side[side[1] - '1']});
        else
          file.fail("a hexahedron has no face " + in_quotes(side) +
                    "; allowed are S1 to S6.");
        return true;
      }


      void
      name_sets()
      {
        for (const auto &entry : element_sets.all())
          if (!entry.second.is_internal)
            {
              const std::string &name      = entry.second.name;
              unsigned int       n_unknown = 0;
              for (const auto number : entry.second.numbers)
                {
                  const auto hexahedron    = hexahedra.find(number);
                  const auto quadrilateral = quadrilaterals.find(number);
                  if (hexahedron != hexahedra.end())
                    mesh.hexahedron_sets[name].push_back(hexahedron->second);
                  else if (quadrilateral != quadrilaterals.end())
                    mesh.quadrilateral_sets[name].push_back(
                      quadrilateral->second);
                  else
                    {
                      refuse_missing(name, number);
                      ++n_unknown;
                    }
                }
              note_unknown(name, n_unknown);
            }
        for (const auto &entry : node_sets.all())
          if (!entry.second.is_internal)
            {
              auto &set = mesh.vertex_sets[entry.second.name];
              set.insert(set.end(),
                         entry.second.numbers.begin(),
                         entry.second.numbers.end());
            }
      }


      // An element of another type is left out; a missing element is an error.
      void
      refuse_missing(const std::string &name, const std::int64_t number) const
      {
        if (others.count(number) == 0)
          throw UserError(file.name + ": the set or surface \"" + name +
                          "\" names element " + std::to_string(number) +
                          ", which the file does not have; export the mesh "
                          "again, or correct the set.");
      }


      void
      note_unknown(const std::string &name, const unsigned int n) const
      {
        if (n > 0)
          note(counted(n, "element", "elements") + " of set \"" + name +
               "\" left out: no hexahedra or quadrilaterals of this file");
      }


      void
      note(const std::string &text) const
      {
        if (report != nullptr)
          *report << file.name << ": " << text << '\n';
      }

      MeshFile     &file;
      std::ostream *report;
      FileMesh      mesh;

      AbaqusSets            element_sets, node_sets, surfaces;
      std::set<std::string> parts;
      bool is_in_assembly = false; // but not within an instance

      // indices by element number
      std::unordered_map<std::int64_t, unsigned int> hexahedra, quadrilaterals;
      std::set<std::int64_t> others; // numbers of elements that are not read
    };
  } // namespace


  FileMesh
  read_abaqus(MeshFile &file, std::ostream *report)
  {
    return AbaqusReader(file, report).run();
  }
} // namespace Voussoir
