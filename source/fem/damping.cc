#include <voussoir/base/error.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/fem/damping.h>

#include <deal.II/base/numbers.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <cmath>
#include <iomanip>
#include <numeric>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string first_mode = "first mode";

    // Reference frequency where no modes are computed [Hz].
    constexpr double usual_reference = 3.;
  } // namespace


  void
  DampingParameters::declare(ParameterHandler &prm)
  {
    add_option(
      prm,
      "Model",
      model,
      "Maxwell: a constant ratio over the band, with a slightly smaller time "
      "step. Rayleigh: the ratio at the two ends of the band, with a much "
      "smaller time step. Mass proportional: the ratio at the lowest "
      "frequency only.");
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
                      "Number of Maxwell branches; with 3 the damping ratio "
                      "varies by about 5 % over a band of 1 to 20 Hz.",
                      Patterns::Integer(1, most_branches));
    prm.add_parameter(
      "Reference frequency",
      reference,
      "Frequency of the free vibration for which the materials' moduli hold "
      "under Maxwell damping [Hz]; in slower motion they are smaller, in "
      "faster motion larger. \"first mode\": the lowest natural frequency if "
      "section \"Modes\" computes any, else 3; 0: the relaxed moduli.");
    prm.add_parameter(
      "Mesh viscosity",
      mesh_viscosity,
      "Damping ratio at the highest frequency of the mesh, of waves that are "
      "too short for the cells, in models whose materials can crack or yield; "
      "within the band at most 0.005. Without this viscosity the oscillation "
      "after one crack causes further cracks.",
      Patterns::Double(0., 0.3));
    prm.add_parameter("From modes",
                      modes,
                      "Two modes, as in \"1, 3\": Rayleigh damping has its "
                      "ratio at their natural frequencies (see section "
                      "\"Modes\") instead of the ends of the band. Empty: the "
                      "band.",
                      Patterns::List(Patterns::Integer(1), 0, 2));
  }


  void
  DampingParameters::check(const unsigned int n_modes) const
  {
    if (!modes.empty())
      {
        if (model != DampingModel::rayleigh)
          throw UserError("\"From modes\" in section \"Damping\" is for the "
                          "\"Model\" Rayleigh only, not " +
                          option_name(model) + "; leave it empty.");
        if (modes.size() != 2 || modes[0] == modes[1])
          throw UserError("\"From modes\" in section \"Damping\" must name "
                          "two different modes, as in \"1, 3\".");
        const unsigned int last = std::max(modes[0], modes[1]);
        if (last > n_modes)
          throw UserError("\"From modes\" in section \"Damping\" names mode " +
                          std::to_string(last) +
                          ", but \"Number\" in section \"Modes\" is " +
                          std::to_string(n_modes) + "; set it to " +
                          std::to_string(last) + " or more.");
      }
    if (const auto number = parse_number(reference);
        reference != first_mode && (!number || *number < 0.))
      throw UserError("\"Reference frequency\" in section \"Damping\" is \"" +
                      reference +
                      "\"; give a frequency [Hz], 0 for the relaxed "
                      "moduli, or \"" +
                      first_mode + "\".");
    if (model != DampingModel::none && lowest_frequency >= highest_frequency)
      throw UserError("In section \"Damping\" the \"Lowest frequency\" must be "
                      "below the \"Highest frequency\".");
  }


  bool
  DampingParameters::follows_first_mode() const
  {
    return model == DampingModel::maxwell && ratio > 0. &&
           reference == first_mode;
  }


  bool
  DampingParameters::depends_on_modes() const
  {
    return !modes.empty() || follows_first_mode();
  }


  Damping::Damping(const DampingParameters   &parameters,
                   const std::vector<double> &natural_frequencies)
    : parameters(parameters)
    , reference(parse_number(parameters.reference).value_or(usual_reference))
  {
    if (parameters.model == DampingModel::maxwell && parameters.ratio > 0.)
      fit_maxwell();
    else if (parameters.model == DampingModel::rayleigh)
      fit_rayleigh(parameters.lowest_frequency, parameters.highest_frequency);
    else if (parameters.model == DampingModel::mass_proportional)
      mass_coefficient =
        4. * numbers::PI * parameters.ratio * parameters.lowest_frequency;
    if (natural_frequencies.empty())
      return;
    if (parameters.follows_first_mode())
      {
        reference = natural_frequencies[0];
        adapted   = true;
      }
    if (!parameters.modes.empty())
      fit_rayleigh(natural_frequencies.at(parameters.modes[0] - 1),
                   natural_frequencies.at(parameters.modes[1] - 1));
  }


  Damping
  Damping::none()
  {
    DampingParameters parameters;
    parameters.model = DampingModel::none;
    return Damping(parameters);
  }


  void
  Damping::add_mesh_viscosity(const double undamped_limit)
  {
    // xi = pi f beta; the mesh has frequencies up to w = 2 / (its stable step)
    mesh_viscosity =
      std::min(parameters.mesh_viscosity * undamped_limit,
               0.005 / (numbers::PI * parameters.highest_frequency));
  }


  void
  Damping::fit_rayleigh(const double first_frequency,
                        const double second_frequency)
  {
    const double w1       = 2. * numbers::PI * first_frequency;
    const double w2       = 2. * numbers::PI * second_frequency;
    mass_coefficient      = 2. * parameters.ratio * w1 * w2 / (w1 + w2);
    stiffness_coefficient = 2. * parameters.ratio / (w1 + w2);
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


  double
  Damping::branch_stiffness() const
  {
    return std::accumulate(coefficients.begin(), coefficients.end(), 0.);
  }


  unsigned int
  Damping::n_branches() const
  {
    return coefficients.size();
  }


  double
  Damping::stiffening(const double dt) const
  {
    return 2. * stiffness_coefficient / dt + branch_stiffness();
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
  Damping::ratio_of_branches(const double frequency, const double factor) const
  {
    double sum = 0.;
    for (unsigned int i = 0; i < coefficients.size(); ++i)
      {
        const double x = 2. * numbers::PI * frequency * relaxation_times[i];
        sum += factor * coefficients[i] * x / (1. + x * x);
      }
    return 0.5 * sum / modulus_ratio(frequency, factor);
  }


  double
  Damping::ratio(const double frequency, const double factor) const
  {
    const double w = 2. * numbers::PI * frequency;
    return ratio_of_branches(frequency, factor) +
           0.5 * (mass_coefficient / w +
                  (factor * stiffness_coefficient + mesh_viscosity) * w);
  }


  double
  Damping::reference_frequency() const
  {
    return reference;
  }


  double
  Damping::modulus(const double frequency, const double factor) const
  {
    return modulus_ratio(frequency, factor) * stiffness_scale(factor);
  }


  double
  Damping::stiffness_scale(const double factor) const
  {
    // free vibration, exp(s t) with s = (i - xi) w, has under -k S (1 + 2 i xi)
    // s^2 = -(1 - xi^2 + 2 i xi) w^2, so that w^2 = k S (1 + xi^2)
    const double xi = adapted ? ratio_of_branches(reference, factor) : 0.;
    return 1. / (modulus_ratio(reference, factor) * (1. + xi * xi));
  }


  void
  Damping::print(std::ostream &out) const
  {
    if (parameters.model == DampingModel::none || parameters.ratio == 0.)
      {
        out << "Damping: none\n";
        return;
      }
    out << "Damping: " << option_name(parameters.model) << ", asked "
        << 100. * parameters.ratio << " %, achieved\n    ";
    out << std::fixed;
    for (const double f : {0.5, 1., 2., 3., 5., 10., 20., 30.})
      out << "  " << std::setprecision(f < 1. ? 1 : 0) << f << " Hz "
          << std::setprecision(1) << 100. * ratio(f) << " %";
    out << std::defaultfloat << '\n';
    if (n_branches() == 0)
      return;
    out << "    moduli hold at " << std::setprecision(4) << reference << " Hz"
        << (adapted ? ", in free vibration in the first mode" :
            parameters.follows_first_mode() ? ", as no modes are known" :
                                              "")
        << "; of them " << std::setprecision(3) << modulus(0.) << " relaxed";
    for (const double f : {1., 3., 10.})
      out << ", " << modulus(f) << " at " << f << " Hz";
    out << '\n';
  }
} // namespace Voussoir
