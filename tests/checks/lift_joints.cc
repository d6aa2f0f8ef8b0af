#include <voussoir/mesh/mesh_geometry.h>

#include <map>
#include <set>

#include "check.h"
#include "cylinder_dam.h"

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
            bool falls = true;
            for (std::size_t i = 1; i < volumes.size(); ++i)
              falls =
                falls && std::abs(volumes[i].at(joint) - expected) <
                           0.4 * std::abs(volumes[i - 1].at(joint) - expected);
            verdicts.is_true("its error falls below 0.4 of it with half the "
                             "cell size",
                             falls);
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
       *  joint, with a cell at the base [m3]; the whole dam if the joint does
       *  not cut it. */
      static double
      volume_below(const CoarseMesh                    &mesh,
                   const std::vector<CoarseMesh::Face> &joint)
      {
        using Vertices     = std::set<unsigned int>;
        const auto of_face = [&](const CoarseMesh::Face &face) {
          Vertices result;
          for (unsigned int v = 0; v < 8; ++v)
            if ((v >> (face.face / 2) & 1) == face.face % 2)
              result.insert(mesh.cells[face.cell][v]);
          return result;
        };
        std::set<Vertices> cut;
        for (const CoarseMesh::Face &face : joint)
          cut.insert(of_face(face));

        std::map<Vertices, std::vector<unsigned int>> cells;
        unsigned int                                  lowest           = 0;
        double                                        lowest_elevation = 1e300;
        for (const unsigned int cell : mesh.cell_sets.at("dam"))
          {
            for (unsigned int face = 0; face < 6; ++face)
              if (const Vertices of = of_face({cell, face}); cut.count(of) == 0)
                cells[of].push_back(cell);
            double z = 0.;
            for (const unsigned int v : mesh.cells[cell])
              z += mesh.vertices[v][2];
            if (z < lowest_elevation)
              {
                lowest_elevation = z;
                lowest           = cell;
              }
          }

        std::set<unsigned int>    reached{lowest};
        std::vector<unsigned int> open{lowest};
        double                    sum = 0.;
        while (!open.empty())
          {
            const unsigned int cell = open.back();
            open.pop_back();
            sum += cell_volume(mesh, cell);
            for (unsigned int face = 0; face < 6; ++face)
              if (const auto both = cells.find(of_face({cell, face}));
                  both != cells.end())
                for (const unsigned int next : both->second)
                  if (reached.insert(next).second)
                    open.push_back(next);
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
