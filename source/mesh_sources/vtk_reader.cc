#include <voussoir/base/error.h>
#include <voussoir/mesh_sources/vtk_reader.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>
#include <ostream>

namespace Voussoir
{
  namespace
  {
    const std::map<int, std::string> refused_vtk_types = {
      {10, "tetrahedra"},
      {13, "wedges"},
      {14, "pyramids"},
      {24, "tetrahedra with 10 nodes"},
      {25, "hexahedra with 20 nodes"},
      {26, "wedges with 15 nodes"},
      {27, "pyramids with 13 nodes"},
      {29, "hexahedra with 27 nodes"},
      {42, "polyhedra"},
      {72, "Lagrange hexahedra with many nodes"}};

    const std::map<int, std::string> ignored_vtk_types = {
      {1, "points"},
      {2, "groups of points"},
      {3, "lines"},
      {4, "lines of several pieces"},
      {5, "triangles"},
      {6, "strips of triangles"},
      {7, "polygons"},
      {21, "lines with 3 nodes"},
      {22, "triangles with 6 nodes"},
      {23, "quadrilaterals with 8 nodes"},
      {28, "quadrilaterals with 9 nodes"}};

    // Names of the array of materials without signs, in order of preference.
    const std::vector<std::string> material_arrays = {"materialid",
                                                      "materialids",
                                                      "material",
                                                      "blockid",
                                                      "block",
                                                      "cellentityids",
                                                      "region"};


    std::string
    letters_of(const std::string &name)
    {
      std::string letters;
      for (const unsigned char c : name)
        if (std::isalnum(c))
          letters += std::tolower(c);
      return letters;
    }


    class VtkReader
    {
    public:
      VtkReader(MeshFile &file, std::ostream *report)
        : file(file)
        , report(report)
      {}

      FileMesh
      run()
      {
        read_header();
        while (!file.at_end())
          read_section();
        if (types.size() + 1 != offsets.size())
          file.fail(
            "there are " + std::to_string(types.size()) + " types for " +
            std::to_string(std::max<std::size_t>(offsets.size(), 1) - 1) +
            " cells; the file is damaged.");
        add_cells();
        return std::move(mesh);
      }

    private:
      void
      read_header()
      {
        if (file.line("the header").substr(0, 5) != "# vtk")
          file.fail("a VTK legacy file begins with \"# vtk DataFile Version\"; "
                    "save the mesh as VTK legacy file.");
        file.skip_line(); // title
        const auto format = file.word("ASCII or BINARY");
        if (format != "ASCII" && format != "BINARY")
          file.fail("expected ASCII or BINARY, but found " + in_quotes(format) +
                    "; the file is damaged.");
        is_binary = (format == "BINARY");
        file.expect("DATASET");
        const std::string dataset(file.word("a kind of dataset"));
        if (dataset != "UNSTRUCTURED_GRID")
          file.fail("the dataset is " + in_quotes(dataset) +
                    ", but only UNSTRUCTURED_GRID is read; convert it, for "
                    "example by the filter \"Append Datasets\" of ParaView.");
      }


      void
      read_section()
      {
        const std::string section(file.word("a section"));
        if (section == "POINTS")
          {
            const auto n = file.count("the number of points");
            const auto x = read_typed_values(3 * n);
            for (std::size_t i = 0; i < n; ++i)
              mesh.vertices.emplace_back(
                i, dealii::Point<3>(x[3 * i], x[3 * i + 1], x[3 * i + 2]));
          }
        else if (section == "CELLS")
          read_cells();
        else if (section == "CELL_TYPES")
          {
            const auto n = file.count("the number of cells");
            file.skip_line();
            types = whole(read_values(n, "int"));
          }
        else if (section == "CELL_DATA" || section == "POINT_DATA")
          {
            is_cell_data = (section == "CELL_DATA");
            n_data       = file.count("the number of tuples");
          }
        else if (section == "METADATA")
          do
            file.skip_line();
          while (!file.peek_line().empty());
        else
          read_array(section);
      }


      // From version 5 on the cells are offsets into one list of points; in
      // earlier versions each cell begins with its number of points.
      void
      read_cells()
      {
        const auto n    = file.count("the number of cells");
        const auto size = file.count("the length of the list");
        file.skip_line();
        if (file.peek_line().substr(0, 7) == "OFFSETS")
          {
            file.expect("OFFSETS");
            offsets = whole(read_typed_values(n));
            file.expect("CONNECTIVITY");
            connectivity = whole(read_typed_values(size));
          }
        else
          {
            const std::vector<double> list = whole(read_values(size, "int"));
            offsets.push_back(0);
            for (std::size_t i = 0; i < size; i += 1 + list[i])
              {
                if (!(list[i] >= 0 && i + list[i] < size))
                  file.fail(
                    "the last cell is incomplete; the file is damaged.");
                connectivity.insert(connectivity.end(),
                                    list.begin() + i + 1,
                                    list.begin() + i + 1 + list[i]);
                offsets.push_back(connectivity.size());
              }
            if (offsets.size() != n + 1)
              file.fail("there are " + std::to_string(offsets.size() - 1) +
                        " cells instead of " + std::to_string(n) +
                        "; the file is damaged.");
          }
      }


      // One array of data, or a field with several.
      void
      read_array(const std::string &section)
      {
        static const std::map<std::string, unsigned int> n_components = {
          {"SCALARS", 1},
          {"VECTORS", 3},
          {"NORMALS", 3},
          {"TENSORS", 9},
          {"TENSORS6", 6},
          {"GLOBAL_IDS", 1},
          {"PEDIGREE_IDS", 1}};

        const std::string name(file.word("the name of an array"));
        if (section == "FIELD")
          {
            const auto n = file.count("the number of arrays");
            for (unsigned int i = 0; i < n; ++i)
              {
                const std::string array(file.word("the name of an array"));
                const auto n_components = file.count("a number of components");
                const auto n_tuples     = file.count("a number of tuples");
                keep_array(array, read_typed_values(n_components * n_tuples));
              }
          }
        else if (n_components.count(section) > 0)
          {
            const std::string      type(file.word("a type of numbers"));
            std::size_t            n_values = n_components.at(section) * n_data;
            const std::string_view rest     = file.line("the data");
            if (section == "SCALARS" && !rest.empty())
              n_values *= file.to_number<unsigned int>(rest, "a number");
            if (file.peek_line().substr(0, 12) == "LOOKUP_TABLE")
              file.skip_line();
            keep_array(name, read_values(n_values, type));
          }
        else
          file.fail("the section " + in_quotes(section) +
                    " is not read; save the mesh with its points, cells and "
                    "scalar cell data only.");
      }


      void
      keep_array(const std::string &name, std::vector<double> values)
      {
        if (is_cell_data && values.size() == types.size())
          arrays[letters_of(name)] = std::move(values);
      }


      std::vector<double>
      read_typed_values(const std::size_t n)
      {
        const std::string type(file.word("a type of numbers"));
        file.skip_line();
        return read_values(n, type);
      }


      std::vector<double>
      read_values(const std::size_t n, const std::string &type)
      {
        std::vector<double> values;
        if (!is_binary)
          for (std::size_t i = 0; i < n; ++i)
            values.push_back(file.number<double>("a number"));
        else if (type == "float")
          read_binary<float>(values, n);
        else if (type == "double")
          read_binary<double>(values, n);
        else if (type == "int" || type == "unsigned_int")
          read_binary<std::int32_t>(values, n);
        else if (type == "long" || type == "vtktypeint64" ||
                 type == "vtkIdType" || type == "unsigned_long")
          read_binary<std::int64_t>(values, n);
        else if (type == "short" || type == "unsigned_short")
          read_binary<std::int16_t>(values, n);
        else if (type == "char" || type == "unsigned_char")
          read_binary<std::int8_t>(values, n);
        else
          file.fail("numbers of type " + in_quotes(type) +
                    " are not read; save the mesh as ASCII with double and "
                    "int data.");
        return values;
      }


      // Converts numbers of points and cells, and types, to integers.
      std::vector<double>
      whole(std::vector<double> values) const
      {
        for (const double value : values)
          if (!(std::abs(value) <= 1e15 && value == std::floor(value)))
            file.fail("there are numbers of points or cells that are no whole "
                      "numbers; the file is damaged.");
        return values;
      }


      // Binary VTK files are big-endian.
      template <typename Number>
      void
      read_binary(std::vector<double> &values, const std::size_t n)
      {
        const std::string_view block =
          file.bytes(sizeof(Number) * file.check_count(n, "a number of values"),
                     "binary data");
        for (std::size_t i = 0; i < n; ++i)
          {
            std::array<char, sizeof(Number)> bytes;
            for (std::size_t k = 0; k < sizeof(Number); ++k)
              bytes[k] = block[(i + 1) * sizeof(Number) - 1 - k];
            Number value;
            std::memcpy(&value, bytes.data(), sizeof(Number));
            values.push_back(value);
          }
      }


      void
      add_cells()
      {
        const std::vector<double> *materials = find_materials();
        for (std::size_t i = 0; i < types.size(); ++i)
          {
            const int         type = static_cast<int>(types[i]);
            const std::string material =
              materials != nullptr ? material_name((*materials)[i]) : "";
            if (type == 11 || type == 12)
              {
                if (materials != nullptr)
                  mesh.hexahedron_sets["material " + material].push_back(
                    mesh.hexahedra.size());
                auto vertices = vertices_of<8>(i);
                if (type ==
                    11) // the vertices of a voxel are in lexicographic order
                  {
                    std::swap(vertices[2], vertices[3]);
                    std::swap(vertices[6], vertices[7]);
                  }
                mesh.hexahedra.push_back(
                  {static_cast<std::int64_t>(i), vertices});
              }
            else if (type == 8 || type == 9) // pixels and quadrilaterals
              {
                if (materials != nullptr)
                  mesh.quadrilateral_sets["boundary " + material].push_back(
                    mesh.quadrilaterals.size());
                mesh.quadrilaterals.push_back(
                  {static_cast<std::int64_t>(i), vertices_of<4>(i)});
              }
            else if (ignored_vtk_types.count(type) > 0)
              ++mesh.ignored[ignored_vtk_types.at(type)];
            else if (refused_vtk_types.count(type) > 0)
              ++mesh.refused[refused_vtk_types.at(type)];
            else
              ++mesh.refused["cells of VTK's type " + std::to_string(type)];
          }
      }


      const std::vector<double> *
      find_materials() const
      {
        for (const std::string &name : material_arrays)
          if (arrays.count(name) > 0)
            return &arrays.at(name);
        if (report != nullptr)
          *report << file.name
                  << ": no cell data array is called MaterialID, Material, "
                     "BlockID, Block, CellEntityIDs or Region, so there are no "
                     "named sets\n";
        return nullptr;
      }


      std::string
      material_name(const double material) const
      {
        if (material != std::floor(material) || !(std::abs(material) <= 1e9))
          throw UserError(file.name + ": the array of materials holds " +
                          std::to_string(material) +
                          "; only integers up to 1e9 are allowed.");
        return std::to_string(static_cast<std::int64_t>(material));
      }


      template <int n>
      std::array<std::int64_t, n>
      vertices_of(const std::size_t cell) const
      {
        if (offsets[cell] < 0 || offsets[cell + 1] - offsets[cell] != n ||
            offsets[cell + 1] > connectivity.size())
          throw UserError(file.name + ": cell " + std::to_string(cell) +
                          " does not have " + std::to_string(n) +
                          " points; the file is damaged.");
        std::array<std::int64_t, n> vertices;
        std::copy_n(connectivity.begin() +
                      static_cast<std::ptrdiff_t>(offsets[cell]),
                    n,
                    vertices.begin());
        return vertices;
      }

      MeshFile     &file;
      std::ostream *report;
      FileMesh      mesh;
      bool          is_binary    = false;
      bool          is_cell_data = false;
      std::size_t   n_data       = 0;

      std::vector<double>                        types;
      std::vector<double>                        offsets;
      std::vector<double>                        connectivity;
      std::map<std::string, std::vector<double>> arrays;
    };
  } // namespace


  FileMesh
  read_vtk(MeshFile &file, std::ostream *report)
  {
    return VtkReader(file, report).run();
  }
} // namespace Voussoir
