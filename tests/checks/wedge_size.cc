#include <deal.II/grid/reference_cell.h>

#include <sstream>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The log's report of a wedge of rock whose size is rounded to cells: in
     * the straight bank x = 20 + 0.8 z behind a straight dam 10 m thick, with a
     * level base plane at z = 40, which meets the bank at x = 52, a wedge that
     * is w wide and l long has the volume w^2 / 1.6 (l + 10). Columns are 10 m
     * wide, but 9.6 m beyond the column that the foot shortens; 28.8 m are
     * nearest to the 25 m given.
     */
    class WedgeSize : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        std::ostringstream log;
        const CoarseMesh   mesh      = make_case(file)->make_mesh(log);
        const auto         number_of = [&](const std::string &before) {
          const std::string text = log.str();
          const auto        at = text.find(before, text.find("Left wedge"));
          return at == std::string::npos ?
                           std::numeric_limits<double>::quiet_NaN() :
                           std::stod(text.substr(at + before.size()));
        };
        const double width  = number_of("Left wedge: "),
                     length = number_of("asked for), "),
                     volume = number_of("volume ");
        verdicts.near("width", width, 28.8, 1e-3, "m");
        const double own = extent(mesh, "downstream face")[0] -
                           extent(mesh, "left wedge base")[0];
        verdicts.below("length: error against the mesh",
                       length / own - 1.,
                       1e-3);
        verdicts.below("volume: error against that of both",
                       volume / (width * width / 1.6 * (length + 10.)) - 1.,
                       2e-3);
      }

    private:
      /** Along the river [m]. */
      static std::array<double, 2>
      extent(const CoarseMesh &mesh, const std::string &set)
      {
        std::array<double, 2> result{{1e300, -1e300}};
        for (const auto &[cell, face] : mesh.face_sets.at(set))
          for (unsigned int i = 0; i < 4; ++i)
            {
              const double y =
                mesh.vertices
                  [mesh.cells[cell][ReferenceCells::Hexahedron
                                      .face_to_cell_vertices(face, i, 1)]][1];
              keep_smallest(result[0], y);
              keep_largest(result[1], y);
            }
        return result;
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<WedgeSize>
      registered("wedge size", "Size of a wedge as the log has it.");
  } // namespace
} // namespace Voussoir
