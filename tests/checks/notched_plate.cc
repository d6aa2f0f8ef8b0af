#include <voussoir/fem/nodal_values.h>

#include <deque>

#include "check.h"
#include "slice_mesh.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr double width = 99., height = 207., notch = 18.; // [m]


    /**
     * A plate, one cell of size h thick, with a notch from its left side at
     * half its height, a row of cells of a set of their own. Right of it the
     * rows of cells rise.
     *
     * @param slope of the rows
     */
    void
    write_plate(const std::string &name, const double h, const double slope)
    {
      const unsigned int columns = std::lround(width / h),
                         rows    = std::lround(height / h);
      SliceMesh mesh(columns, rows);
      for (unsigned int j = 0; j < rows; ++j)
        for (unsigned int i = 0; i < columns; ++i)
          {
            const bool is_notch = 2 * j + 1 == rows && (i + 0.5) * h < notch;
            mesh.add_cell(is_notch ? 2 : 1, i, j);
            mesh.add_side(5, i, j, 0);
          }
      for (unsigned int i = 0; i < columns; ++i)
        {
          mesh.add_level(3, i, 0);
          mesh.add_level(4, i, rows);
        }
      mesh.write(
        name,
        {{3, "plate"}, {3, "notch"}, {2, "bottom"}, {2, "top"}, {2, "side"}},
        h,
        [&](const unsigned int i, const unsigned int j) {
          // parallel rows in the middle, level ends
          const double x = i * h, z = j * h,
                       to_end = std::min(z, height - z) / (0.32 * height),
                       rise   = slope * positive_part(x - notch) *
                              std::min(to_end, 1.);
          return std::pair{x, z + rise};
        });
    }


    /** The stress at which a crack runs through a plate from a notch, in cells
     *  of several times E Gf / ft^2 and along rows in two directions. */
    class NotchedPlate : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        // by tests/data/notched_plate_reference.py with elements of 0.25 and
        // 0.125 m: 0.380 and 0.379 MPa
        constexpr double fictitious_crack = 0.378e6;
        for (const double h : {9., 3.})
          for (const double angle : {0., 30.})
            {
              std::ostringstream name;
              name << ", cells of " << h << " m, rows at " << angle
                   << " degrees";
              const std::string mesh =
                std::filesystem::current_path() /
                ("plate_" + std::to_string(int(h)) + "_" +
                 std::to_string(int(angle)) + ".msh");
              write_plate(mesh, h, std::tan(angle * numbers::PI / 180.));
              const auto parameters =
                make_case(file.with({"Mesh/file/File=" + mesh}));
              const auto simulation =
                make_simulation(*parameters, communicator);
              verdicts.near("stress at which the crack runs" + name.str(),
                            1e-6 * pull(*simulation, h),
                            1e-6 * fictitious_crack,
                            0.11,
                            "MPa");
              const double energy =
                simulation->run.state.material_memory.losses().material /
                (h * (width - notch) / std::cos(angle * numbers::PI / 180.));
              verdicts.near("energy lost per area of the crack" + name.str(),
                            energy,
                            350.,
                            0.15,
                            "J/m2");
            }
      }

    private:
      /** Largest mean stress of the plate, as a mean over 0.05 s [Pa]. */
      double
      pull(Simulation &simulation, const double thickness) const
      {
        Run                            &run = simulation.run;
        const std::vector<unsigned int> pulled =
          run.equation.projections[0]->nodes();
        const unsigned int window  = std::ceil(0.05 / run.time_step.length);
        double             largest = 0., sum = 0.;
        std::deque<double> stresses;
        while (run.state.step < run.n_steps())
          {
            run.scheme.step(run.state);
            double force = 0.;
            for (const unsigned int node : pulled)
              force += run.scheme.support_force(run.state, node)[2];
            stresses.push_back(force / (width * thickness));
            sum += stresses.back();
            if (stresses.size() > window)
              {
                sum -= stresses.front();
                stresses.pop_front();
              }
            keep_largest(largest, std::abs(sum) / window);
          }
        return largest;
      }
    };

    // Reference: other program
    const Registry<Check>::Add<NotchedPlate>
      registered("notched plate", "Crack through a plate on four meshes.");
  } // namespace
} // namespace Voussoir
