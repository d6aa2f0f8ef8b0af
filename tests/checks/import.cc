#include <voussoir/base/error.h>
#include <voussoir/mesh/mesh_geometry.h>
#include <voussoir/mesh_sources/reader.h>

#include <filesystem>
#include <fstream>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The same box of two materials from all formats has the same volumes,
     * areas and sets, and each broken file is refused with its own sentence.
     */
    class Import : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        const std::string folder = file.resolve("../data/meshes/");
        for (const std::string ending : {"gmsh22.msh",
                                         "gmsh22_binary.msh",
                                         "gmsh22_one_entity.msh",
                                         "gmsh40.msh",
                                         "gmsh41.msh",
                                         "gmsh41_binary.msh",
                                         "abaqus.inp",
                                         "abaqus_cae.inp",
                                         "ucd.inp",
                                         "vtk3.vtk",
                                         "vtk3_binary.vtk",
                                         "vtk5.vtk",
                                         "vtk5_binary.vtk"})
          compare(folder, "box_two_materials_" + ending, verdicts);
        compare(folder, "box_two_materials.ucd", verdicts);
        refuse(folder + "broken/", verdicts);
      }

    private:
      // Lower rock, 10 m x 20 m x 20 m, and dam, twice as large, of a box on
      // its base; the interface between the two carries a name too.
      void
      compare(const std::string &folder,
              const std::string &name,
              Verdicts          &verdicts) const
      {
        const CoarseMesh mesh   = read_mesh(folder + name, nullptr);
        double           volume = 0.;
        for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
          volume += cell_volume(mesh, cell);
        verdicts.near(name + ": volume", volume, 12000., 1e-9, "m3");

        // names differ where the format knows numbers only
        std::vector<double> volumes;
        for (const auto &set : mesh.cell_sets)
          {
            volumes.push_back(0.);
            for (const unsigned int cell : set.second)
              volumes.back() += cell_volume(mesh, cell);
          }
        verdicts.is_true("  cell sets of 4000 and 8000 m3",
                         has(volumes, 4000.) && has(volumes, 8000.));
        bool base = false, interface = false;
        for (const auto &set : mesh.face_sets)
          {
            double area = 0.;
            for (const CoarseMesh::Face &face : set.second)
              area += face_area(mesh, face);
            base = base || (set.second.size() == 6 && has({area}, 600.));
            interface =
              interface || (set.second.size() == 4 && has({area}, 400.));
          }
        verdicts.is_true("  base of 6 faces and 600 m2", base);
        verdicts.is_true("  interface of 4 faces and 400 m2", interface);
        if (mesh.vertex_sets.size() > 0)
          verdicts.is_true("  sets carry the names of the file",
                           (mesh.cell_sets.count("rock") == 1 ||
                            mesh.cell_sets.count("Rock") == 1) &&
                             (mesh.face_sets.count("base") == 1 ||
                              mesh.face_sets.count("Base") == 1));
      }


      static bool
      has(const std::vector<double> &values, const double wanted)
      {
        for (const double value : values)
          if (std::abs(value - wanted) < 1e-9 * wanted)
            return true;
        return false;
      }


      // Each sentence names its file.
      void
      refuse(const std::string &folder, Verdicts &verdicts) const
      {
        std::vector<std::string> expected;
        std::ifstream            in(folder + "expected_sentences.txt");
        for (std::string line; std::getline(in, line);)
          expected.push_back(line);

        std::set<std::string> names; // in alphabetical order
        for (const auto &item : std::filesystem::directory_iterator(folder))
          if (item.path().filename() != "expected_sentences.txt")
            names.insert(item.path().filename().string());
        for (const std::string &name : names)
          {
            std::string sentence = name + " is accepted";
            try
              {
                read_mesh(folder + name, nullptr);
              }
            catch (const UserError &error)
              {
                sentence = error.what();
                if (const auto at = sentence.find(folder);
                    at != std::string::npos)
                  sentence.erase(at, folder.size());
              }
            const bool known =
              std::find(expected.begin(), expected.end(), sentence) !=
              expected.end();
            verdicts.is_true(known ? name + " is refused as it should" :
                                     name + ": " + sentence,
                             known);
          }
        verdicts.is_true("as many broken files as sentences",
                         names.size() == expected.size());
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<Import>
      registered("mesh import", "All formats, and files that are refused.");
  } // namespace
} // namespace Voussoir
