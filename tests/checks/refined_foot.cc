#include "contact_mesh.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A gravity dam, refined once, on rock that is not, with an interface
     * between them: rock along the edges of the foot is refined, too, so that
     * no node hangs on one side only. The interface has the area of the foot
     * and carries the weight of the dam, of 103 m and 15 m along the axis.
     */
    class RefinedFoot : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        for (const std::string side : {"foundation", "foundation (other side)"})
          {
            unsigned int n_fine = 0;
            simulation->model.grid.for_each_face(
              side, [&](const auto &cell, const unsigned int) {
                n_fine += cell->level() == 1 ? 1 : 0;
              });
            // of 2 x 6 faces each is cut into four
            verdicts.near("refined faces, " + side,
                          Utilities::MPI::sum(n_fine, communicator),
                          4 * 12,
                          0.);
          }
        double area = 0., force = 0.;
        for (const ContactPoint &point :
             simulation->static_state.contact->points())
          {
            area += point.area;
            force += point.force[0];
          }
        verdicts.near("area of the foot [m2]",
                      Utilities::MPI::sum(area, communicator),
                      70. * 15.,
                      1e-12);
        const double section =
          0.5 * (70. + 19.25) * 66.5 + 0.5 * (19.25 + 14.8) * 36.5;
        verdicts.near("normal force on the foot [MN]",
                      1e-6 * Utilities::MPI::sum(force, communicator),
                      1e-6 * 2643. * 9.81 * 15. * section,
                      1e-5);

        std::ostringstream report;
        CoarseMesh         mesh     = parameters->make_mesh(report);
        const auto         surfaces = parameters->interfaces.split(mesh);
        for (const unsigned int degree : {1, 2})
          check_ranks(verdicts,
                      mesh,
                      parameters->grid,
                      degree,
                      surfaces.names(),
                      communicator);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<RefinedFoot>
      registered("refined foot", "The foot of a refined dam on coarse rock.");
  } // namespace
} // namespace Voussoir
