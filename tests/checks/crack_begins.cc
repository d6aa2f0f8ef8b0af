#include "march_with_energy.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A damped bar is pulled apart: the energies do not jump as its points
     * leave the elastic range, damping supplies no energy, and the run
     * continues to its end.
     */
    class CrackBegins : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string points : {"Gauss", "one point"})
          for (const std::string nu : {"0", "0.2"})
            for (const auto &[ratio, rise] :
                 std::vector<std::pair<std::string, std::string>>{
                   {"0.02", "0.8"},
                   {"0.05", "0.25"},
                   {"0.05", "0.06"},
                   {"0.15", "0.25"}})
              pull_apart(file.with(
                           {"Discretization/Quadrature=" + points,
                            "Materials/concrete/Poisson's ratio=" + nu,
                            "Damping/Ratio=" + ratio,
                            "Time/End time=" +
                              std::to_string(2. * std::stod(rise)),
                            "Constraints/pull/Time function=t/" + rise}),
                         points + ", Poisson's ratio " + nu + ", damping " +
                           ratio + ", strength at " + rise + " s: ",
                         verdicts,
                         communicator);
      }

    private:
      static void
      pull_apart(const ParameterFile &file,
                 const std::string   &name,
                 Verdicts            &verdicts,
                 const MPI_Comm       communicator)
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        Run       &run        = simulation->run;
        double     before = 0., most = 0., fall = 0., jump = 0.;
        march_with_energy(run, [&](const bool evaluated) {
          if (!evaluated)
            return;
          const EnergyTerms &terms = run.energy.latest();
          keep_largest(jump, std::abs(terms.damping - before));
          keep_largest(most, terms.damping);
          keep_largest(fall, most - terms.damping);
          before = terms.damping;
        });
        const auto   summary  = run.energy.summary();
        const double input    = run.energy.latest().constraints;
        const double material = run.energy.latest().material;
        verdicts.above(name + "cracks took, over the work",
                       material / input,
                       0.3);
        verdicts.below("  largest jump of damping", jump / input, 0.004);
        verdicts.below("  given back by damping", fall / input, 0.004);
        verdicts.below("  largest energy-balance error",
                       summary.largest_error,
                       0.01);
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<CrackBegins>
      registered("crack begins", "Energy as damped points begin to crack.");
  } // namespace
} // namespace Voussoir
