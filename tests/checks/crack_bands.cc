#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Widths of crack bands in cells of simple shapes. */
    class CrackBandsCheck : public Check
    {
    public:
      void
      run(const ParameterFile &, Verdicts &verdicts, const MPI_Comm) override
      {
        const auto point = [](const double x, const double y, const double z) {
          return Tensor<1, 3>({x, y, z});
        };
        const Tensor<1, 3> x = point(1, 0, 0), y = point(0, 1, 0),
                           z = point(0, 0, 1);
        // edges, normal, width
        evaluate("cube, edge", {{x, y, z}}, x, 1., verdicts);
        evaluate("cube, diagonal of a face",
                 {{x, y, z}},
                 x + y,
                 std::sqrt(2.),
                 verdicts);
        evaluate("cube, diagonal",
                 {{x, y, z}},
                 x + y + z,
                 2. / std::sqrt(3.),
                 verdicts);
        evaluate(
          "four times as long, along it", {{x, y, 4. * z}}, z, 4., verdicts);
        evaluate(
          "four times as long, across it", {{x, y, 4. * z}}, x, 1., verdicts);
        // the crack is parallel to two edges: the distance of the faces
        evaluate("sheared by 30 degrees",
                 {{x, y, z + std::tan(numbers::PI / 6.) * x}},
                 z,
                 1.,
                 verdicts);
        evaluate("half the cell", {{x, y, 4. * z}}, z, 2., verdicts, 0.5);
      }

    private:
      static void
      evaluate(const std::string                 &name,
               const std::array<Tensor<1, 3>, 3> &edges,
               const Tensor<1, 3>                &normal,
               const double                       width,
               Verdicts                          &verdicts,
               const double                       share = 1.)
      {
        std::vector<Point<3>> vertices;
        for (unsigned int v = 0; v < 8; ++v)
          {
            Point<3> vertex;
            for (unsigned int d = 0; d < 3; ++d)
              if ((v >> d) & 1)
                vertex += edges[d];
            vertices.push_back(vertex);
          }
        CellData<3> corners(8);
        std::iota(corners.vertices.begin(), corners.vertices.end(), 0);
        Triangulation<3> triangulation;
        triangulation.create_triangulation(vertices, {corners}, {});
        CrackBands bands;
        bands.set_lane(0, triangulation.begin_active(), share);
        Tensor<1, 3, Lanes> n;
        for (unsigned int d = 0; d < 3; ++d)
          n[d] = normal[d] / normal.norm();
        verdicts.near(
          "band of a " + name, bands.across(n)[0], width, 1e-12, "m");
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<CrackBandsCheck>
      registered("crack bands", "Width of the band of a crack in a cell.");
  } // namespace
} // namespace Voussoir
