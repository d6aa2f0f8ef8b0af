#include <voussoir/fem/nodal_values.h>

#include <deque>
#include <fstream>

#include "check.h"

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
      const auto node =
        [&](const unsigned int i, const unsigned int j, const unsigned int k) {
          return 1 + (j * (columns + 1) + i) * 2 + k;
        };
      std::vector<std::string> elements;
      const auto               add = [&](const std::string               &kind,
                           const unsigned int               set,
                           const std::vector<unsigned int> &nodes) {
        std::ostringstream text;
        text << elements.size() + 1 << ' ' << kind << " 2 " << set << ' '
             << set;
        for (const unsigned int number : nodes)
          text << ' ' << number;
        elements.push_back(text.str());
      };
      for (unsigned int j = 0; j < rows; ++j)
        for (unsigned int i = 0; i < columns; ++i)
          {
            const bool is_notch = 2 * j + 1 == rows && (i + 0.5) * h < notch;
            std::vector<unsigned int> corners;
            for (const unsigned int k : {0, 1})
              for (const auto &[a, b] :
                   {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
                corners.push_back(node(i + a, j + b, k));
            add("5", is_notch ? 2 : 1, corners);
            add("3", 5, {corners.begin(), corners.begin() + 4});
          }
      for (unsigned int i = 0; i < columns; ++i)
        for (const unsigned int j : {0U, rows})
          add("3",
              j == 0 ? 3 : 4,
              {node(i, j, 0),
               node(i + 1, j, 0),
               node(i + 1, j, 1),
               node(i, j, 1)});
      std::ofstream file(name);
      file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n"
              "3 1 \"plate\"\n3 2 \"notch\"\n2 3 \"bottom\"\n2 4 \"top\"\n"
              "2 5 \"side\"\n$EndPhysicalNames\n$Nodes\n"
           << 2 * (columns + 1) * (rows + 1) << '\n';
      for (unsigned int j = 0; j <= rows; ++j)
        for (unsigned int i = 0; i <= columns; ++i)
          for (unsigned int k = 0; k < 2; ++k)
            {
              // parallel rows in the middle, level ends
              const double x = i * h, z = j * h,
                           to_end = std::min(z, height - z) / (0.32 * height),
                           rise   = slope * positive_part(x - notch) *
                                  std::min(to_end, 1.);
              file << node(i, j, k) << ' ' << x << ' ' << -(h * k) << ' '
                   << z + rise << '\n';
            }
      file << "$EndNodes\n$Elements\n" << elements.size() << '\n';
      for (const std::string &element : elements)
        file << element << '\n';
      file << "$EndElements\n";
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
