#include <filesystem>
#include <random>

#include "check.h"
#include "crack_line.h"
#include "slice_mesh.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr double side = 0.5, half = 0.25, cell_size = 0.025, // [m]
      load_at = 0.47;


    /**
     * The L-shaped panel, one cell thick, without its lower right quarter. Left
     * of the re-entrant corner the rows of cells rise to the left. Its right
     * end, beyond 0.375 m, stays elastic; a soft cell passes the load on.
     *
     * @param slope of the rows
     * @param irregularity by which nodes are moved at random, over a cell
     */
    void
    write_panel(const std::string &name,
                const double       slope,
                const double       irregularity)
    {
      const unsigned int n = std::lround(side / cell_size), middle = n / 2,
                         loaded = load_at / cell_size,
                         ends   = std::lround(0.375 / cell_size);
      SliceMesh mesh(n, n);
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int i = 0; i < n; ++i)
          {
            const bool is_pin = i == loaded && j == middle - 1;
            if (i >= middle && j < middle && !is_pin)
              continue;
            mesh.add_cell(is_pin ? 3 : i >= ends ? 2 : 1, i, j);
            mesh.add_side(6, i, j, 0);
          }
      for (unsigned int i = 0; i < middle; ++i)
        mesh.add_level(4, i, 0);
      mesh.add_level(5, loaded, middle - 1);

      std::mt19937                       random(3);
      std::vector<std::array<double, 2>> moved((n + 1) * (n + 1));
      for (auto &of_node : moved)
        for (double &component : of_node)
          component = irregularity * cell_size *
                      (2. * (random() / double(std::mt19937::max())) - 1.);
      mesh.write(name,
                 {{3, "panel"},
                  {3, "end"},
                  {3, "pin"},
                  {2, "bottom"},
                  {2, "loaded"},
                  {2, "side"}},
                 cell_size,
                 [&](const unsigned int i, const unsigned int j) {
                   double x = i * cell_size, z = j * cell_size;
                   z += slope * positive_part(half - x) *
                        std::min(std::min(z, side - z) / 0.2, 1.);
                   const bool is_inside = i > 0 && i < n && j > 0 && j < n &&
                                          !(i >= middle && j <= middle);
                   if (is_inside)
                     {
                       x += moved[j * (n + 1) + i][0];
                       z += moved[j * (n + 1) + i][1];
                     }
                   // the load hardly resists a rotation of the arm
                   if (j == middle - 1 && (i == loaded || i == loaded + 1))
                     x = (loaded + (i == loaded ? 0.42 : 0.58)) * cell_size;
                   return std::pair{x, z};
                 });
    }


    /** The L-shaped panel of Winkler (2001), on meshes with rows at angles and
     *  an irregular one. */
    class LPanel : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        // of a cohesive crack along a ray from the corner, 0.1 m thick; rays
        // that rise by 10 to 20 degrees are the weakest
        constexpr double work = 1.55, load = 7000., rise = 15.; // [J, N]
        struct Mesh
        {
          std::string name;
          double      angle, irregularity;
        };
        for (const auto &[name, angle, irregularity] :
             {Mesh{"level", 0., 0.},
              Mesh{"at 25 degrees", 25., 0.},
              Mesh{"at -25 degrees", -25., 0.},
              Mesh{"irregular", 0., 0.25}})
          {
            const std::string mesh =
              std::filesystem::current_path() /
              ("panel_" + std::to_string(int(angle)) + "_" +
               std::to_string(int(4. * irregularity)) + ".msh");
            write_panel(mesh,
                        std::tan(angle * numbers::PI / 180.),
                        irregularity);
            const auto parameters =
              make_case(file.with({"Mesh/file/File=" + mesh}));
            const auto simulation = make_simulation(*parameters, communicator);
            const Pull pull       = march_under_pull(*simulation, 1.5e-3);
            const double to_panel = 0.1 / cell_size;
            verdicts.near("largest load, rows " + name,
                          1e-3 * to_panel * pull.largest,
                          1e-3 * load,
                          0.1,
                          "kN");
            verdicts.near(
              "work of the pull, rows " + name,
              to_panel *
                double(simulation->run.state.accounts.work_of_projections),
              work,
              0.1,
              "J");
            verdicts.below("load left over the largest, rows " + name,
                           pull.last / pull.largest,
                           0.05);
            verdicts.near("rise of the crack, rows " + name,
                          -angle_of_cracks(*simulation,
                                           [](const Point<3> &point) {
                                             return point[0] < half;
                                           }),
                          rise,
                          0.87,
                          "degrees");
          }
      }
    };

    // Reference: other program
    const Registry<Check>::Add<LPanel>
      registered("L panel", "Crack from the corner of a panel on four meshes.");
  } // namespace
} // namespace Voussoir
