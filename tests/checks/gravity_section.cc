#include <voussoir/mesh/mesh_geometry.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A slice of 2 m: heel at y = 6, the upstream face upright above z = 60,
     * neck of 20 m at z = 70, crest of 10 m at z = 100, base of 80 m; water up
     * to the bend, from the heel to y = 56. All faces are plane, so that the
     * mesh has the dimensions of the drawing. Lifts of 35 m end at the
     * fourth of seven rows up to the bend, and at the neck.
     */
    class GravitySection : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        std::ostringstream ignored;
        const CoarseMesh   mesh   = make_case(file)->make_mesh(ignored);
        const auto         volume = [&](const std::string &set) {
          double sum = 0.;
          for (const unsigned int cell : mesh.cell_sets.at(set))
            sum += cell_volume(mesh, cell);
          return sum;
        };
        const auto area = [&](const std::string &set) {
          double sum = 0.;
          for (const CoarseMesh::Face &face : mesh.face_sets.at(set))
            sum += face_area(mesh, face);
          return sum;
        };
        const std::vector<Point<2>> corners{{6., 0.},
                                            {0., 60.},
                                            {0., 100.},
                                            {-10., 100.},
                                            {-20., 70.},
                                            {-74., 0.}};
        double                      section = 0.;
        for (unsigned int i = 0; i < corners.size(); ++i)
          {
            const Point<2> &a = corners[i],
                           &b = corners[(i + 1) % corners.size()];
            section += 0.5 * (a[0] * b[1] - b[0] * a[1]);
          }
        verdicts.near(
          "volume of the dam", volume("dam"), 2. * section, 1e-12, "m3");
        verdicts.near("volume of the water",
                      volume("reservoir"),
                      2. * (50. * 60. + 0.5 * 6. * 60.),
                      1e-12,
                      "m3");
        verdicts.near("upstream face",
                      area("upstream face"),
                      2. * (std::hypot(6., 60.) + 40.),
                      1e-12,
                      "m2");
        verdicts.near("downstream face",
                      area("downstream face"),
                      2. * (std::hypot(54., 70.) + std::hypot(10., 30.)),
                      1e-12,
                      "m2");
        const double z = 4. / 7. * 60.;
        verdicts.near("lower lift joint",
                      area("lift 1"),
                      2. * (80. - (6. / 60. + 54. / 70.) * z),
                      1e-12,
                      "m2");
        verdicts.near(
          "upper lift joint", area("lift 2"), 2. * 20., 1e-12, "m2");
        verdicts.is_true("two lift joints",
                         mesh.face_sets.count("lift 3") == 0);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<GravitySection>
      registered("gravity section",
                 "Volumes and faces of a dam with an upstream batter.");
  } // namespace
} // namespace Voussoir
