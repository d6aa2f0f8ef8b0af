#include <voussoir/mesh/interfaces.h>
#include <voussoir/mesh/mesh_check.h>

#include <deal.II/grid/reference_cell.h>

#include "contact_mesh.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The wedges of rock in the banks of an arch dam, at several elevations:
     * the mesh does not tangle, each wedge is a body of its own once the dam is
     * cut off its rock, and the bottom is level.
     */
    class AbutmentWedgeCheck : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        for (const unsigned int elevation : {20, 40, 100, 200, 250})
          {
            std::vector<std::string> changes;
            for (const char *bank : {"Left", "Right"})
              changes.push_back(
                std::string("Mesh/arch dam/") + bank +
                " wedge/Elevation=" + std::to_string(elevation));
            const auto         parameters = make_case(file.with(changes));
            std::ostringstream report;
            CoarseMesh         mesh = parameters->make_mesh(report);
            check_mesh(mesh, "Test");

            double lowest  = std::numeric_limits<double>::max(),
                   highest = -lowest;
            for (const char *name : {"left wedge bottom", "right wedge bottom"})
              for (const CoarseMesh::Face &face : mesh.face_sets.at(name))
                for (unsigned int v = 0; v < 4; ++v)
                  {
                    const double z =
                      mesh.vertices[mesh.cells[face.cell]
                                              [ReferenceCells::Hexahedron
                                                 .face_to_cell_vertices(
                                                   face.face, v, 1)]][2];
                    lowest = std::min(lowest, z);
                    keep_largest(highest, z);
                  }
            const std::string at = std::to_string(elevation) + " m: ";
            // feet of the coarse columns are up to 90 m apart
            verdicts.below(at + "bottom away from there [m]",
                           highest - elevation,
                           45.);
            verdicts.below(at + "level to [m]", highest - lowest, 1e-9);

            split_interfaces(mesh,
                             {"left wedge bottom",
                              "left wedge side",
                              "left wedge back",
                              "right wedge bottom",
                              "right wedge side",
                              "right wedge back",
                              "dam-rock interface"},
                             "Test");
            check_mesh(mesh, "Test");
            verdicts.near(at + "dam, rock and wedges", n_bodies(mesh), 4., 0.);
          }
      }
    };

    const Registry<Check>::Add<AbutmentWedgeCheck>
      registered("abutment wedge", "Wedges of rock in the banks.");
  } // namespace
} // namespace Voussoir
