#include <voussoir/materials/random_field.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Mean, variance and correlation of random fields, over a hundred seeds and
     * two hundred points of each, at the correlation lengths and twice those;
     * bounds are some four standard deviations of such means. Mean and
     * deviation of the lognormal factors of the classes.
     */
    class RandomFieldStatistics : public Check
    {
    public:
      void
      run(const ParameterFile &, Verdicts &verdicts, const MPI_Comm) override
      {
        const std::vector<double> lengths{20., 20., 5.};
        constexpr unsigned int    n_seeds = 100, n_points = 200;
        double                    mean = 0., variance = 0.;
        std::array<double, 4>     products{};
        for (unsigned int seed = 1; seed <= n_seeds; ++seed)
          {
            const RandomField field(lengths, seed);
            for (unsigned int i = 0; i < n_points; ++i)
              {
                // far from each other, and not on a lattice
                const Point<3> point(37. * i,
                                     1000. * std::sin(1. * i),
                                     1000. * std::sin(2.3 * i));
                const double   value = field(point);
                mean += value / (n_seeds * n_points);
                variance += value * value / (n_seeds * n_points);
                for (const auto &[product, distance] :
                     {std::pair(0, Point<3>(20., 0., 0.)),
                      std::pair(1, Point<3>(0., 0., 5.)),
                      std::pair(2, Point<3>(0., 40., 0.)),
                      std::pair(3, Point<3>(0., 0., 200.))})
                  products[product] +=
                    value * field(point + distance) / (n_seeds * n_points);
              }
          }
        verdicts.below("mean", mean, 0.03);
        verdicts.below("variance less 1", variance - 1., 0.04);
        verdicts.below("correlation at the length in x less 1/e",
                       products[0] - std::exp(-1.),
                       0.03);
        verdicts.below("  at the length in z",
                       products[1] - std::exp(-1.),
                       0.03);
        verdicts.below("  at twice the length in y less exp(-4)",
                       products[2] - std::exp(-4.),
                       0.03);
        verdicts.below("  far away", products[3], 0.03);
        verdicts.is_true("the same seed gives the same field",
                         RandomField(lengths, 7)(Point<3>(1., 2., 3.)) ==
                           RandomField(lengths, 7)(Point<3>(1., 2., 3.)));
        verdicts.is_true("another one does not",
                         RandomField(lengths, 7)(Point<3>(1., 2., 3.)) !=
                           RandomField(lengths, 8)(Point<3>(1., 2., 3.)));

        constexpr unsigned int n_classes = 16;
        constexpr double       variation = 0.2;
        double                 sum = 0., squares = 0.;
        for (unsigned int i = 0; i < n_classes; ++i)
          {
            const double factor = factor_of_class(i, n_classes, variation);
            sum += factor / n_classes;
            squares += factor * factor / n_classes;
          }
        verdicts.near("mean of the factors of 16 classes", sum, 1., 1e-12);
        // by scipy: scipy.stats.norm.cdf of the bounds of the classes
        verdicts.near("  their deviation over that of the lognormal ones",
                      std::sqrt(squares - sum * sum) / variation,
                      0.9854777,
                      1e-6);
        verdicts.near("  factor of the weakest",
                      factor_of_class(0, n_classes, variation),
                      0.6659567,
                      1e-6);
        verdicts.near("  factor of the strongest",
                      factor_of_class(n_classes - 1, n_classes, variation),
                      1.4521893,
                      1e-6);
        verdicts.is_true("classes are parted at equal shares",
                         random_class(-0.001, 2) == 0 &&
                           random_class(0.001, 2) == 1 &&
                           random_class(-0.675, 4) == 0 &&
                           random_class(-0.674, 4) == 1 &&
                           random_class(40., 4) == 3);
      }
    };


    /**
     * A column of random stiffness that settles by its weight: the sum of
     * rho g h (H - z) / E over its cells, each as stiff as the class of the
     * field at its centre.
     */
    class RandomColumn : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        constexpr double height = 20., modulus = 1e9, weight = 2000. * 9.81;
        constexpr unsigned int n_cells = 20, n_classes = 16;
        const RandomField      field({4., 4., 4.}, 3);
        double                 settlement = 0.;
        for (unsigned int i = 0; i < n_cells; ++i)
          {
            const double centre = i + 0.5;
            const double factor =
              factor_of_class(random_class(field(Point<3>(0.5, 0.5, centre)),
                                           n_classes),
                              n_classes,
                              0.3);
            settlement += weight * (height - centre) / (modulus * factor);
          }
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        verdicts.is_true("the material has become 16",
                         parameters->materials.objects.size() == n_classes);
        verdicts.near(
          "settlement [m]",
          simulation->static_state.initial.displacement.linfty_norm(),
          settlement,
          1e-5);
        const double uniform = 0.5 * weight * height * height / modulus;
        verdicts.above("  differs from that of a uniform one, share",
                       std::abs(settlement / uniform - 1.),
                       0.001);

        const auto cracking =
          make_case(file.with({"Materials/stone/Class=rock damage",
                               "Materials/stone/Random field/"
                               "Strength variation=0.4",
                               "Materials/stone/Cohesion=1e6",
                               "Materials/stone/Residual cohesion=0.9"}));
        verdicts.is_true("the cohesion varies, its share that remains does not",
                         cracking->file.given(
                           "Materials/stone 16/Residual cohesion") == "0.9" &&
                           cracking->file.given(
                             "Materials/stone 16/Cohesion") != "1e6");

        // the file that the run has written gives the same model
        std::ostringstream text;
        parameters->prm.print_parameters(text, ParameterHandler::ShortText);
        verdicts.is_true("the file as it was run has each class",
                         text.str().find("subsection stone 16") !=
                           std::string::npos);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<RandomFieldStatistics>
      statistics("random field", "Mean, variance and correlation.");
    // Reference: closed form
    const Registry<Check>::Add<RandomColumn>
      column("random column", "A column of random stiffness.");
  } // namespace
} // namespace Voussoir
