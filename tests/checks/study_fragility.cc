#include <voussoir/driver/fragility.h>

#include "check.h"
#include "folders.h"
#include "study_results.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Curves of given counts. The references are the optima of the same
     * likelihood by scipy.optimize.minimize (Nelder-Mead, tolerance 1e-12) and
     * bounds from the expected information on ln(median) and ln(dispersion)
     * by numerical differences, with scipy.stats.norm.
     */
    class FragilityOfCounts : public Check
    {
    public:
      void
      run(const ParameterFile &, Verdicts &verdicts, const MPI_Comm) override
      {
        // 40 motions at each level
        const FragilityCurve curve({{0.2, 40, 0},
                                    {0.3, 40, 0},
                                    {0.4, 40, 0},
                                    {0.6, 40, 4},
                                    {0.7, 40, 6},
                                    {0.8, 40, 13},
                                    {0.9, 40, 12},
                                    {1., 40, 16}},
                                   0.95);
        near(verdicts,
             "median",
             *curve.median,
             {1.0761158, 0.9363668, 1.2367218});
        near(verdicts,
             "dispersion",
             *curve.dispersion,
             {0.4292372, 0.2950402, 0.6244728});
        verdicts.near("probability at the median",
                      curve.probability(curve.median->value),
                      0.5,
                      1e-12);
        // one dispersion below the median: Phi(-1)
        verdicts.near("  one dispersion below it",
                      curve.probability(curve.median->value *
                                        std::exp(-curve.dispersion->value)),
                      0.1586552539,
                      1e-9);

        const auto verdict =
          [&verdicts](const std::vector<IntensityLevel> &levels,
                      const std::string                 &begin) {
            const FragilityCurve found(levels, 0.9);
            verdicts.is_true(begin,
                             found.verdict.rfind(begin, 0) == 0 &&
                               !found.median && !found.dispersion);
          };
        verdict({{0.5, 10, 0}, {1., 10, 0}}, "no run");
        verdict({{0.5, 10, 10}, {1., 10, 10}}, "all runs");
        verdict({{0.5, 10, 0}, {1., 10, 10}}, "the median is within 0.5 and 1");
        verdict({{0.5, 10, 0}, {0.8, 10, 4}, {1., 10, 10}},
                "the median is within 0.8 and 0.8");
        verdict({{0.5, 10, 6}, {1., 10, 2}}, "the criterion is not met more");
      }

    private:
      static void
      near(Verdicts              &verdicts,
           const std::string     &name,
           const BoundedEstimate &found,
           const BoundedEstimate &expected)
      {
        verdicts.near(name, found.value, expected.value, 1e-6);
        verdicts.near("  from", found.lower, expected.lower, 1e-6);
        verdicts.near("  to", found.upper, expected.upper, 1e-6);
      }
    };


    /**
     * Columns of five stiffnesses under four densities, whose settlement rho g
     * H^2 / 2 E exceeds a millimetre in 1, 2, 3 and 4 of them; the curve by
     * scipy, as above, with a confidence of 0.9.
     */
    class FragilityOfColumns : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders({"fragility"}, communicator);
        const std::string number = "static state/stages/*/largest "
                                   "displacement [m]";
        const auto        lines =
          results_of(
            study_file(file, "study_columns", "fragility")
              .with({"Study/Vary=Materials/stone/Density = 1000, 2000, 3000, "
                     "4000; Materials/stone/Young's modulus = 4e8, 8e8, 12e8, "
                     "16e8, 24e8",
                     "Study/Spread over=Materials/stone/Young's modulus",
                     "Study/Fragility/Intensity=Materials/stone/Density",
                     "Study/Fragility/Criterion=" + number + " > 1e-3"}),
            communicator)
            .at("fragility")
            .at("levels");
        verdicts.is_true("four levels", lines.size() == 4);
        for (unsigned int i = 0; i < 4; ++i)
          verdicts.is_true("  runs and those that settle by more",
                           lines.at(i).at("intensity") == 1000. * (i + 1) &&
                             lines.at(i).at("runs") == 5 &&
                             lines.at(i).at("criterion met") == i + 1);
        for (const auto &[name, expected] :
             {std::pair("median", 2238.994),
              std::pair("median from", 1470.954),
              std::pair("median to", 3408.055),
              std::pair("dispersion", 0.8531977),
              std::pair("dispersion from", 0.3622738),
              std::pair("dispersion to", 2.009382)})
          verdicts.near(name, lines.at(0).at(name), expected, 1e-5);
        verdicts.is_true("the table is written",
                         std::filesystem::exists(
                           "fragility/study_fragility.csv"));
      }
    };

    // Reference: other program
    const Registry<Check>::Add<FragilityOfCounts>
      counts("fragility of counts", "Fragility curves by maximum likelihood.");
    // Reference: other program
    const Registry<Check>::Add<FragilityOfColumns>
      columns("fragility of columns", "The fragility curve of a study.");
  } // namespace
} // namespace Voussoir
