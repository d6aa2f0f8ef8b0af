#include <voussoir/fem/point_weights.h>

#include "contact_mesh.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A column with a level joint, pressed from above, whose cells are refined
     * on one side of a part of the joint: those on its other side follow, the
     * areas of the contact points sum up to that of the joint, and with hanging
     * nodes in the joint the pressure p is transmitted as by a column without
     * joint, which shortens by p H / E.
     */
    class RefinedJoint : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        constexpr double pressure = 3e5, modulus = 1e9, height = 4., area = 16.;
        const auto       parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const Grid  &grid       = simulation->model.grid;
        unsigned int n_fine = 0, n_faces = 0;
        for (const std::string side : {"plane", "plane (other side)"})
          grid.for_each_face(side, [&](const auto &cell, const unsigned int) {
            ++n_faces;
            n_fine += cell->level() == 1 ? 1 : 0;
          });
        // of 16 faces on each side, 8 are cut into four
        verdicts.near("faces of the joint, both sides",
                      Utilities::MPI::sum(n_faces, communicator),
                      2 * (8 + 32),
                      0.);
        verdicts.near("  of these refined",
                      Utilities::MPI::sum(n_fine, communicator),
                      2 * 32,
                      0.);
        double       sum = 0., error = 0.;
        unsigned int n_points = 0;
        for (const ContactPoint &point :
             simulation->static_state.contact->points())
          {
            sum += point.area;
            ++n_points;
            keep_largest(error,
                         std::abs(point.force[0] / (pressure * point.area) -
                                  1.));
          }
        // 5 x 9 nodes in the refined half, of which 4 hang, and 2 x 5 beside
        verdicts.near("contact points",
                      Utilities::MPI::sum(n_points, communicator),
                      5 * 9 - 4 + 2 * 5,
                      0.);
        verdicts.near("their area [m2]",
                      Utilities::MPI::sum(sum, communicator),
                      area,
                      1e-12);
        verdicts.below("their pressure, error",
                       Utilities::MPI::max(error, communicator),
                       1e-3);
        const PointWeights weights(simulation->model.solid.discretization,
                                   {{"coarse", Point<3>(3.5, 2, 4)},
                                    {"fine", Point<3>(0.5, 2, 4)}},
                                   "Point");
        for (unsigned int i = 0; i < 2; ++i)
          verdicts.near(
            i == 0 ? "top above coarse cells [mm]" : "above fine ones [mm]",
            1e3 *
              Utilities::MPI::sum(
                weights.share(simulation->static_state.initial.displacement)[i],
                communicator)[2],
            -1e3 * pressure * height / modulus,
            1e-4);

        std::ostringstream report;
        CoarseMesh         mesh     = parameters->make_mesh(report);
        const auto         surfaces = parameters->interfaces.split(mesh);
        check_ranks(
          verdicts, mesh, parameters->grid, 1, surfaces.names(), communicator);
        verdicts.is_true("degree 2: refused",
                         is_refused(
                           [&] {
                             all_clusters(mesh,
                                          parameters->grid,
                                          2,
                                          surfaces.names(),
                                          communicator);
                           },
                           "has cells of different size"));
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<RefinedJoint>
      registered("refined joint", "Hanging nodes in a joint under pressure.");
  } // namespace
} // namespace Voussoir
