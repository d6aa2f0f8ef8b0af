#include <voussoir/fem/nodal_values.h>

#include "check.h"
#include "slice_mesh.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A beam of 2.1 m by 0.6 m, notched to half its height below the middle,
     * with n cells over the height: a slice of cubes. It is supported over 0.1
     * m at both ends and loaded over 0.1 m in the middle; the crack runs
     * through the column of cells above the notch.
     */
    void
    write_beam(const std::string &name, const unsigned int n)
    {
      const unsigned int columns = 7 * n / 2, rows = n, wide = n / 6;
      const double       h = 0.6 / n;
      SliceMesh          mesh(columns, rows);
      for (unsigned int j = 0; j < rows; ++j)
        for (unsigned int i = 0; i < columns; ++i)
          {
            if (2 * i + 1 == columns && 2 * j < rows)
              continue; // the notch
            mesh.add_cell(1, i, j);
            for (const unsigned int k : {0, 1})
              mesh.add_side(3, i, j, k);
          }
      for (unsigned int i = 0; i < columns; ++i)
        {
          if (i < wide || i >= columns - wide)
            mesh.add_level(2, i, 0);
          if (2 * i + 1 + wide >= columns && 2 * i + 1 <= columns + wide)
            mesh.add_level(4, i, rows);
        }
      mesh.write(name,
                 {{3, "beam"}, {2, "supports"}, {2, "sides"}, {2, "load"}},
                 h,
                 [h](const unsigned int i, const unsigned int j) {
                   return std::pair{h * i, h * j};
                 });
    }


    /** Crack-band regularisation: load and energy are those of a fictitious
     *  crack, found by tests/data/notched_beam_reference.py, and the energy
     *  does not depend on the cells. */
    class NotchedBeam : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        // by elements of 25, 12.5, 6.25 and 4.2 mm: 106.9, 104.6, 103.5, 103.2
        // kN/m and 17.0, 16.8, 16.7, 16.7 J/m
        constexpr double fictitious_crack  = 103e3;
        constexpr double fictitious_energy = 16.7;
        double           lost              = 0.; // of the first mesh
        for (const unsigned int n : {18, 30, 42})
          {
            const std::string mesh = std::filesystem::current_path() /
                                     ("beam_" + std::to_string(n) + ".msh");
            write_beam(mesh, n);
            const auto parameters =
              make_case(file.with({"Mesh/file/File=" + mesh}));
            const auto simulation = make_simulation(*parameters, communicator);
            const auto [load, energy] = press(*simulation, 0.6 / n);
            std::ostringstream name;
            name << " with " << n << " cells over the height";
            if (lost == 0.)
              lost = energy;
            verdicts.near("largest load" + name.str(),
                          1e-3 * load,
                          1e-3 * fictitious_crack,
                          0.06,
                          "kN per m");
            verdicts.near("energy lost" + name.str(),
                          energy,
                          fictitious_energy,
                          0.13,
                          "J/m");
            verdicts.below("energy over that of the first mesh, less 1" +
                             name.str(),
                           energy / lost - 1.,
                           0.1);
            // the ligament is 0.3 m high, and its upper end hardly opens
            verdicts.below("energy over that of the whole ligament, less 1" +
                             name.str(),
                           positive_part(energy / (0.3 * 100.) - 1.),
                           0.1);
          }
      }

    private:
      /** Largest load [N/m] and energy lost at the end [J/m]. */
      std::pair<double, double>
      press(Simulation &simulation, const double thickness) const
      {
        std::vector<unsigned int> pressed;
        for (const Projection *projection : simulation.run.equation.projections)
          pressed = projection->nodes();
        // the load as a mean over about a period of the beam
        const unsigned int last = simulation.run.n_steps();
        const unsigned int window =
          std::ceil(0.003 / simulation.run.time_step.length);
        double              largest = 0., sum = 0.;
        std::vector<double> loads;
        Vector force = simulation.model.solid.discretization.create_vector();
        while (simulation.run.state.step < last)
          {
            simulation.run.scheme.step(simulation.run.state);
            if (simulation.run.state.step % 10 != 0)
              continue;
            simulation.run.equation.internal_force.respond(
              force,
              simulation.run.state.displacement,
              simulation.run.state.material_memory);
            double load = 0.;
            for (const unsigned int node : pressed)
              load -= node_value(force, node)[2];
            loads.push_back(load / thickness);
            sum += loads.back();
            if (loads.size() > window / 10)
              sum -= loads[loads.size() - 1 - window / 10];
            keep_largest(largest, sum / (window / 10));
          }
        return {largest,
                simulation.run.state.material_memory.losses().material /
                  thickness};
      }
    };

    // Reference: other program
    const Registry<Check>::Add<NotchedBeam>
      registered("notched beam", "Crack in a beam on three meshes.");
  } // namespace
} // namespace Voussoir
