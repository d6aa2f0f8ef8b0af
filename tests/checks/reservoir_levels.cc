#include <voussoir/base/text.h>
#include <voussoir/driver/case.h>
#include <voussoir/mesh/mesh_geometry.h>

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
            const auto                  &water = mesh.cell_sets.at("reservoir");
            const std::set<unsigned int> is_water(water.begin(), water.end());
            std::set<std::pair<unsigned int, unsigned int>> named;
            for (const std::string name : {"water surface", "reservoir end"})
              for (const CoarseMesh::Face &face : mesh.face_sets.at(name))
                named.emplace(face.cell, face.face);
            const std::vector<SortedFace> faces = sorted_faces(mesh);
            const auto                    same  = [&faces](const std::size_t i,
                                       const std::size_t j) {
              return j < faces.size() && faces[i].vertices == faces[j].vertices;
            };
            unsigned int n_faces = 0, n_unnamed = 0;
            for (std::size_t i = 0; i < faces.size(); ++i)
              if (const auto [cell, face] = faces[i].face;
                  is_water.count(cell) > 0 && !same(i, i - 1) &&
                  !same(i, i + 1))
                {
                  ++n_faces;
                  n_unnamed += named.count({cell, face}) == 0;
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
