#include <voussoir/base/text.h>
#include <voussoir/driver/case.h>

#include <deal.II/base/geometry_info.h>

#include <map>
#include <set>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The water of a generated arch dam at several levels, also where it ends
     * beside a joint: each of its faces is one of dam or rock, too, or belongs
     * to its surface or its end.
     */
    class ReservoirLevels : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Levels", levels, "Reservoir levels [m].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        for (const std::string &level : split_list(levels))
          {
            const CoarseMesh mesh =
              make_case(file.with({"Mesh/arch dam/Reservoir level=" + level}))
                ->generator->generate();
            std::map<std::set<unsigned int>, unsigned int> n_cells;
            const auto corners = [&](const unsigned int cell,
                                     const unsigned int face) {
              std::set<unsigned int> vertices;
              for (unsigned int v = 0; v < 4; ++v)
                vertices.insert(
                  mesh.cells[cell]
                            [GeometryInfo<3>::face_to_cell_vertices(face, v)]);
              return vertices;
            };
            for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
              for (unsigned int face = 0; face < 6; ++face)
                ++n_cells[corners(cell, face)];
            std::set<std::set<unsigned int>> named;
            for (const std::string name : {"water surface", "reservoir end"})
              for (const CoarseMesh::Face &face : mesh.face_sets.at(name))
                named.insert(corners(face.cell, face.face));
            unsigned int n_faces = 0, n_unnamed = 0;
            for (const unsigned int cell : mesh.cell_sets.at("reservoir"))
              for (unsigned int face = 0; face < 6; ++face)
                {
                  const auto vertices = corners(cell, face);
                  n_faces += n_cells.at(vertices) == 1;
                  n_unnamed +=
                    n_cells.at(vertices) == 1 && named.count(vertices) == 0;
                }
            verdicts.is_true(level + " m: the water has outer faces",
                             n_faces > 0);
            verdicts.near("  of them without a name", n_unnamed, 0., 0.);
          }
      }

    private:
      std::string levels;
    };

    // Reference: closed form
    const Registry<Check>::Add<ReservoirLevels>
      registered("reservoir levels",
                 "The surface of the water beside a generated arch dam.");
  } // namespace
} // namespace Voussoir
