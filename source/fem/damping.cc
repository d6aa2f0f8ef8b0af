#include <voussoir/base/error.h>
#include <voussoir/fem/damping.h>

#include <deal.II/base/numbers.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <cmath>
#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  void
  DampingParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Model",
      model,
      "Maxwell: the same ratio over the whole band, for a small price in the "
      "time step. Rayleigh: the ratio at the two ends of the band, for a large "
      "price. Mass proportional: the ratio at the lowest frequency only.",
      Patterns::Selection("Maxwell|Rayleigh|mass proportional|none"));
    prm.add_parameter("Ratio",
                      ratio,
                      "Fraction of critical damping; materials can scale it.",
                      Patterns::Double(0., 0.3));
    prm.add_parameter("Lowest frequency",
                      lowest_frequency,
                      "Lower end of the band [Hz].",
                      Patterns::Double(1e-3));
    prm.add_parameter("Highest frequency",
                      highest_frequency,
                      "Upper end of the band [Hz].",
                      Patterns::Double(1e-3));
    prm.add_parameter("Branches",
                      branches,
                      "Number of Maxwell branches; 3 hold the ratio within "
                      "about 5 % of itself over a band of 1 to 20.",
                      Patterns::Integer(1, 6));
    prm.add_parameter("Reference frequency",
                      reference,
                      "Frequency at which the materials' moduli hold under "
                      "Maxwell damping [Hz]; 0 for at rest.",
                      Patterns::Double(0.));
  }


  void
  DampingParameters::check() const
  {
    if (model != "none" && lowest_frequency >= highest_frequency)
      throw UserError("In section \"Damping\" the \"Lowest frequency\" must be "
                      "below the \"Highest frequency\".");
  }


  Damping::Damping(const DampingParameters &parameters)
    : parameters(parameters)
  {
    const double w1 = 2. * numbers::PI * parameters.lowest_frequency;
    const double w2 = 2. * numbers::PI * parameters.highest_frequency;
    if (parameters.model == "Maxwell" && parameters.ratio > 0.)
      fit_maxwell();
    else if (parameters.model == "Rayleigh")
      {
        mass_coefficient      = 2. * parameters.ratio * w1 * w2 / (w1 + w2);
        stiffness_coefficient = 2. * parameters.ratio / (w1 + w2);
      }
    else if (parameters.model == "mass proportional")
      mass_coefficient = 2. * parameters.ratio * w1;
  }


  void
  Damping::fit_maxwell()
  {
    const unsigned int n = parameters.branches;
    const double       span =
      parameters.highest_frequency / parameters.lowest_frequency;
    for (unsigned int i = 0; i < n; ++i)
      relaxation_times.push_back(
        1. / (2. * numbers::PI * parameters.lowest_frequency *
              std::pow(span, n == 1 ? 0.5 : i / (n - 1.))));

    // Least squares of xi S = 1/2 sum D_i w t/(1 + (w t)^2) over the band, with
    // the storage modulus S of the last pass; few passes suffice as S is
    // near 1.
    constexpr unsigned int n_samples = 60;
    coefficients.assign(n, 0.);
    for (unsigned int pass = 0; pass < 30; ++pass)
      {
        FullMatrix<double>     matrix(n, n);
        dealii::Vector<double> rhs(n), solution(n);
        for (unsigned int k = 0; k < n_samples; ++k)
          {
            const double f = parameters.lowest_frequency *
                             std::pow(span, k / (n_samples - 1.));
            const double        w = 2. * numbers::PI * f;
            std::vector<double> row(n);
            for (unsigned int i = 0; i < n; ++i)
              {
                const double x = w * relaxation_times[i];
                row[i]         = 0.5 * x / (1. + x * x);
              }
            const double target = parameters.ratio * modulus_ratio(f);
            for (unsigned int i = 0; i < n; ++i)
              {
                for (unsigned int j = 0; j < n; ++j)
                  matrix(i, j) += row[i] * row[j];
                rhs(i) += row[i] * target;
              }
          }
        matrix.gauss_jordan();
        matrix.vmult(solution, rhs);
        for (unsigned int i = 0; i < n; ++i)
          coefficients[i] = std::max(0., solution(i));
      }
  }


  unsigned int
  Damping::n_branches() const
  {
    return coefficients.size();
  }


  double
  Damping::stiffening(const double dt) const
  {
    double sum = 2. * stiffness_coefficient / dt;
    for (const double D : coefficients)
      sum += D;
    return sum;
  }


  double
  Damping::modulus_ratio(const double frequency, const double factor) const
  {
    double sum = 1.;
    for (unsigned int i = 0; i < coefficients.size(); ++i)
      {
        const double x = 2. * numbers::PI * frequency * relaxation_times[i];
        sum += factor * coefficients[i] * x * x / (1. + x * x);
      }
    return sum;
  }


  double
  Damping::ratio(const double frequency, const double factor) const
  {
    const double w   = 2. * numbers::PI * frequency;
    double       sum = 0.;
    for (unsigned int i = 0; i < coefficients.size(); ++i)
      {
        const double x = w * relaxation_times[i];
        sum += factor * coefficients[i] * x / (1. + x * x);
      }
    return 0.5 * (sum / modulus_ratio(frequency, factor) +
                  mass_coefficient / w + factor * stiffness_coefficient * w);
  }


  double
  Damping::stiffness_scale(const double factor) const
  {
    return 1. / modulus_ratio(parameters.reference, factor);
  }


  void
  Damping::print(std::ostream &out) const
  {
    if (parameters.model == "none" || parameters.ratio == 0.)
      {
        out << "Damping: none\n";
        return;
      }
    out << "Damping: " << parameters.model << ", asked "
        << 100. * parameters.ratio << " %, achieved\n    ";
    out << std::fixed;
    for (const double f : {0.5, 1., 2., 3., 5., 10., 20., 30.})
      out << "  " << std::setprecision(f < 1. ? 1 : 0) << f << " Hz "
          << std::setprecision(1) << 100. * ratio(f) << " %";
    out << std::defaultfloat << '\n';
  }
} // namespace Voussoir
