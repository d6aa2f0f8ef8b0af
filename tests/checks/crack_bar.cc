#include <voussoir/output/material_memory.h>

#include "check.h"
#include "march_with_energy.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A bar along z whose weak cells crack: the expected number of layers of
     * cells, with the energy of as many cracks, while closing cracks gain no
     * energy.
     */
    class CrackBar : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Cracks", cracks, "Layers that crack.");
        prm.add_parameter("Crack energy",
                          crack_energy,
                          "Energy of one crack [J]; 0: not compared.");
        prm.add_parameter("Tolerance", tolerance, "Of that energy.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        Run       &run        = simulation->run;
        double     turnover = 0., made = 0.;
        march_with_energy(run, [&](const bool evaluated) {
          if (!evaluated)
            return;
          const EnergyTerms &terms = run.energy.latest();
          keep_largest(turnover, std::abs(terms.input + terms.constraints));
          // a NaN stays
          made = !(terms.closing > -made) ? -terms.closing : made;
        });

        std::set<long> layers;
        const auto     damage =
          memory_of_cells(simulation->model.solid, run.state.material_memory);
        const auto name = damage.count("tension damage") > 0 ?
                            damage.find("tension damage") :
                            damage.find("damage");
        for (const auto &cell :
             simulation->model.grid.triangulation().active_cell_iterators())
          if (name->second[cell->active_cell_index()] > 0.5)
            layers.insert(std::lround(1e3 * cell->center()[2]));
        verdicts.near("layers that cracked", layers.size(), cracks, 1e-6);
        if (crack_energy > 0.)
          verdicts.near("energy lost in cracks",
                        run.state.material_memory.losses().material,
                        cracks * crack_energy,
                        tolerance,
                        "J");
        verdicts.below("energy made by cracks that close, over the input",
                       made / turnover,
                       1e-3);
        verdicts.below("largest energy-balance error over the input",
                       run.energy.summary().largest_error,
                       0.01);
      }

    private:
      unsigned int cracks       = 1;
      double       crack_energy = 0., tolerance = 0.01;
    };

    // Reference: closed form
    const Registry<Check>::Add<CrackBar>
      registered("crack bar", "A bar with a weak layer of cells.");
  } // namespace
} // namespace Voussoir
