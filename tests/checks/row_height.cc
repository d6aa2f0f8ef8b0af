#include <voussoir/mesh/mesh_quality.h>

#include <deal.II/grid/reference_cell.h>

#include <set>
#include <sstream>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Rows of cells of a dam of 100 m on banks that rise by 1.18: cells of 5 m
     * along the crest make columns of 10 m, over which a bank rises by 11.8 m,
     * so that there are 8 rows of two cells; rows of two cells of 10 m are 5,
     * and those of 2.5 m are 20, in columns that are narrower. Below them is
     * the layer along the rock.
     */
    class RowHeight : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        for (const auto &[wanted, n_rows] :
             std::vector<std::pair<std::string, double>>{{"0", 8.},
                                                         {"10", 5.},
                                                         {"2.5", 20.}})
          {
            std::ostringstream log;
            const CoarseMesh   mesh =
              make_case(file.with({"Mesh/arch dam/Row height=" + wanted}))
                ->make_mesh(log);
            verdicts.heading("Row height = " + wanted);
            verdicts.near("  cells over the height at the crown",
                          levels_at_crown(mesh).size() - 1.,
                          2. * n_rows + 1.,
                          0.);
            const std::string text = log.str(), before = "m along the crest, ";
            verdicts.near("  their height as the log has it",
                          std::stod(
                            text.substr(text.find(before) + before.size())),
                          50. / n_rows,
                          0.01,
                          "m");
            MeshQuality quality;
            for (const unsigned int cell : mesh.cell_sets.at("dam"))
              {
                std::array<Point<3>, 8> vertices;
                for (unsigned int v = 0; v < 8; ++v)
                  vertices[v] = mesh.vertices[mesh.cells[cell][v]];
                quality.take(vertices);
              }
            verdicts.above("  scaled Jacobian", quality.scaled_jacobian, 0.2);
          }
      }

    private:
      /** Elevations of the vertices of the upstream face at x = 0, in
       *  millimetres. */
      static std::set<long>
      levels_at_crown(const CoarseMesh &mesh)
      {
        std::set<long> levels;
        for (const auto &[cell, face] : mesh.face_sets.at("upstream face"))
          for (unsigned int i = 0; i < 4; ++i)
            {
              const Point<3> &x =
                mesh.vertices[mesh.cells[cell]
                                        [ReferenceCells::Hexahedron
                                           .face_to_cell_vertices(face, i, 1)]];
              if (std::abs(x[0]) < 1e-6)
                levels.insert(std::lround(1e3 * x[2]));
            }
        return levels;
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<RowHeight> registered("row height",
                                                     "Rows of cells of a dam.");
  } // namespace
} // namespace Voussoir
