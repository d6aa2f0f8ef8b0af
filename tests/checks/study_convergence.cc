#include <voussoir/driver/convergence.h>

#include "check.h"
#include "folders.h"
#include "study_results.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Numbers 7 + 0.3 h^p of known order, a published example, and numbers
     *  that do not converge. */
    class ConvergenceOfNumbers : public Check
    {
    public:
      void
      run(const ParameterFile &, Verdicts &verdicts, const MPI_Comm) override
      {
        for (const ThreeSizes &sizes : {ThreeSizes{{4., 2., 1.}},
                                        ThreeSizes{{2.25, 1.5, 1.}},
                                        ThreeSizes{{3., 1.5, 1.}}})
          for (const double order : {2., 1., 1.3})
            {
              const auto number = [order](const double size) {
                return 7. + 0.3 * std::pow(size, order);
              };
              const Convergence found(
                sizes,
                {{number(sizes[0]), number(sizes[1]), number(sizes[2])}},
                2.);
              std::ostringstream name;
              name << "ratios " << sizes[0] / sizes[1] << " and "
                   << sizes[1] / sizes[2] << ", order " << order;
              verdicts.heading(name.str());
              verdicts.near("  observed order", *found.order, order, 1e-9);
              verdicts.near("  extrapolated", *found.limit, 7., 1e-9);
              verdicts.near("  band", *found.band, 1.25 * 0.3, 1e-9);
            }

        // NPARC Alliance, Examining spatial (grid) convergence
        const Convergence recovery({{4., 2., 1.}},
                                   {{0.96178, 0.96854, 0.97050}},
                                   2.);
        verdicts.near("pressure recovery of an inlet: order",
                      *recovery.order,
                      1.78617,
                      1e-5);
        verdicts.near("  extrapolated", *recovery.limit, 0.97130, 1e-5);
        verdicts.near("  band [%]",
                      100. * *recovery.band / 0.97050,
                      0.103083,
                      1e-4);

        const auto verdict = [&verdicts](const ThreeSizes  &sizes,
                                         const ThreeSizes  &values,
                                         const std::string &begin) {
          const Convergence found(sizes, values, 2.);
          verdicts.is_true(begin,
                           found.verdict.rfind(begin, 0) == 0 &&
                             found.converges == found.band.has_value() &&
                             found.converges == (begin == "does not change"));
        };
        verdict({{4., 2., 1.}}, {{3., 3., 3.}}, "does not change");
        verdict({{4., 2., 1.}}, {{0., 0., 0.}}, "does not change");
        verdict({{4., 2., 1.}}, {{3., 2., 2.5}}, "oscillates");
        // a crack's tip, whose stress grows with h^-1/2
        verdict({{4., 2., 1.}}, {{0.5, std::sqrt(0.5), 1.}}, "diverges");
        verdict({{4., 2., 1.}}, {{1., 2., 3.}}, "diverges");
        verdict({{4., 2., 1.}},
                {{std::pow(4., 0.3), std::pow(2., 0.3), 1.}},
                "order below 0.5");
        verdict({{4., 2., 1.}}, {{65., 9., 2.}}, "order above that");
        verdict({{4., 2., 1.}}, {{3., 2., 2.}}, "order above that");
        verdict({{2., 2., 1.}}, {{3., 2., 1.5}}, "the sizes");
      }
    };


    /**
     * The largest displacement of a ring in plane strain under pressure p, at
     * its inner radius a: Lame's p a (1 + nu) / E * (a^2 (1 - 2 nu) + b^2) /
     * (b^2 - a^2), in three meshes.
     */
    class ConvergenceOfRing : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        constexpr double a = 1., b = 3., modulus = 10e9, nu = 0.25, p = 1e6,
                         lame = p * a * (1. + nu) / modulus *
                                (a * a * (1. - 2. * nu) + b * b) /
                                (b * b - a * a);
        remove_folders({"ring"}, communicator);
        const auto lines =
          results_of(study_file(file, "study_ring", "ring"), communicator)
            .at("convergence");
        verdicts.is_true("one quantity converges",
                         lines.size() == 1 &&
                           lines.at(0).at("verdict") == "converges");
        const nlohmann::json &line = lines.at(0);
        const double          fine = line.at("fine"),
                     extrapolated  = line.at("extrapolated"),
                     band          = line.at("band about the fine one");
        verdicts.near("size of the coarse cells over that of the middle ones",
                      line.at("coarse over middle"),
                      2.,
                      1e-12);
        verdicts.below("order less two",
                       line.at("observed order").get<double>() - 2.,
                       0.2);
        verdicts.near("extrapolated [mm]",
                      1e3 * extrapolated,
                      1e3 * lame,
                      1e-4);
        verdicts.below("error of the finest over its band",
                       (fine - lame) / band,
                       1.);
        verdicts.above("  and no less of it than",
                       std::abs(fine - lame) / band,
                       0.5);
        verdicts.is_true("the table is written",
                         std::filesystem::exists("ring/study_convergence.csv"));
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<ConvergenceOfNumbers>
      numbers("convergence of numbers",
              "Richardson's extrapolation of numbers of known order.");
    // Reference: closed form
    const Registry<Check>::Add<ConvergenceOfRing>
      ring("convergence of a ring",
           "A study of three meshes against Lame's solution.");
  } // namespace
} // namespace Voussoir
