#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A bar of two materials in cells of 20 m: "Nodes per wavelength" 8 at 10
     * Hz requires cells of at most 12.5 m where S waves have 1000 m/s, and of
     * 37.5 m where they have 3000 m/s.
     */
    class RefinedForWaves : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto  parameters = make_case(file);
        const auto  simulation = make_simulation(*parameters, communicator);
        const Grid &grid       = simulation->model.grid;
        std::vector<double> n_cells(2), longest(2), shortest(2, 1e300);
        for (const auto &cell : grid.triangulation().active_cell_iterators())
          if (cell->is_locally_owned())
            {
              const unsigned int m = grid.material(cell);
              ++n_cells[m];
              keep_largest(longest[m], longest_edge(cell));
              keep_smallest(shortest[m], longest_edge(cell));
            }
        Utilities::MPI::sum(n_cells, communicator, n_cells);
        Utilities::MPI::max(longest, communicator, longest);
        Utilities::MPI::min(shortest, communicator, shortest);
        for (const unsigned int m : {0, 1})
          {
            const std::string name = m == 0 ? "soft" : "stiff";
            verdicts.near(name + ": cells", n_cells[m], m == 0 ? 64. : 8., 0.);
            verdicts.near(name + ": longest edge [m]",
                          longest[m],
                          m == 0 ? 10. : 20.,
                          1e-12);
            verdicts.near(name + ": shortest cell [m]",
                          shortest[m],
                          m == 0 ? 10. : 20.,
                          1e-12);
          }
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<RefinedForWaves>
      registered("refined for waves", "Cells as large as waves allow.");
  } // namespace
} // namespace Voussoir
