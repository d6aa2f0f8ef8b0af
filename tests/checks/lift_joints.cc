#include <voussoir/mesh/interface_surface.h>
#include <voussoir/mesh/mesh_geometry.h>

#include <set>

#include "check.h"
#include "cylinder_dam.h"
#include "falling_errors.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Lift joints of a dam in closed form, in three rows of faces: each cuts
     * the dam above it off. Rows bend next to the banks, so that the volume
     * below errs in proportion to the square of the cell size.
     */
    class LiftJoints : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Rows of cells", rows, "From coarse to fine.");
        prm.add_parameter("Tolerance",
                          tolerance,
                          "Tolerance of the finest mesh.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        std::vector<std::vector<double>> volumes;
        for (const double n : rows)
          volumes.push_back(volumes_below(
            file.with(CylinderDam::entries())
              .with({"Mesh/arch dam/Cell size=" + std::to_string(120. / n),
                     "Mesh/arch dam/Row height=" + std::to_string(100. / n)})));
        verdicts.near("joints", volumes.back().size(), 3, 1e-12);
        for (unsigned int joint = 0; joint < volumes.back().size(); ++joint)
          {
            const double expected = CylinderDam::volume(25. * (joint + 1));
            verdicts.near("volume below " + name(joint + 1),
                          volumes.back()[joint],
                          expected,
                          tolerance,
                          "m3");
            std::vector<double> errors;
            for (const auto &of_mesh : volumes)
              errors.push_back(of_mesh.at(joint) - expected);
            verdicts.is_true("its error falls below 0.4 of it with half the "
                             "cell size",
                             fall(errors));
          }
      }

    private:
      /** Volumes below the joints [m3], from below. */
      static std::vector<double>
      volumes_below(const ParameterFile &file)
      {
        std::ostringstream  ignored;
        const CoarseMesh    mesh = make_case(file)->make_mesh(ignored);
        std::vector<double> result;
        for (auto joint = mesh.face_sets.find(name(1));
             joint != mesh.face_sets.end();
             joint = mesh.face_sets.find(name(result.size() + 1)))
          result.push_back(volume_below(mesh, joint->second));
        return result;
      }


      static std::string
      name(const unsigned int joint)
      {
        return "lift " + std::to_string(joint);
      }


      /** Volume of the dam's cells that are connected, by faces outside of the
       *  joint, with the cell below its first face [m3]; that of the whole dam
       *  if the joint does not cut it. */
      static double
      volume_below(const CoarseMesh                    &mesh,
                   const std::vector<CoarseMesh::Face> &joint)
      {
        FaceNeighbours neighbours = find_face_neighbours(mesh);
        const auto cell_below = neighbours[joint[0].cell][joint[0].face].cell;
        for (const CoarseMesh::Face &face : joint)
          {
            const CoarseMesh::Face other = neighbours[face.cell][face.face];
            neighbours[face.cell][face.face].cell   = none;
            neighbours[other.cell][other.face].cell = none;
          }
        const std::vector<unsigned int> &dam = mesh.cell_sets.at("dam");
        const std::set<unsigned int>     of_dam(dam.begin(), dam.end());
        std::set<unsigned int>           reached{cell_below};
        std::vector<unsigned int>        open{cell_below};
        double                           sum = 0.;
        while (!open.empty())
          {
            const unsigned int cell = open.back();
            open.pop_back();
            sum += cell_volume(mesh, cell);
            for (const CoarseMesh::Face &next : neighbours[cell])
              if (of_dam.count(next.cell) > 0 &&
                  reached.insert(next.cell).second)
                open.push_back(next.cell);
          }
        return sum;
      }

      std::vector<double> rows;
      double              tolerance = 0.01;
    };

    // Reference: closed form
    const Registry<Check>::Add<LiftJoints>
      registered("lift joints", "Volumes between the lift joints of a dam.");
  } // namespace
} // namespace Voussoir
