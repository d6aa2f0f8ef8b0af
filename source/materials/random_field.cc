#include <voussoir/materials/random_field.h>

#include <boost/math/distributions/normal.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const boost::math::normal normal;


    /** A uniform number within 0 and 1, the same with any standard library. */
    double
    uniform(std::mt19937_64 &generator)
    {
      return std::ldexp(static_cast<double>(generator() >> 11) + 0.5, -53);
    }


    /** Probability that the shifted field is below the quantile of this share.
     */
    double
    shifted_probability(const double share, const double shift)
    {
      return share <= 0. ? 0. :
             share >= 1. ? 1. :
                           cdf(normal, quantile(normal, share) - shift);
    }
  } // namespace


  void
  RandomFieldParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Modulus variation",
      modulus_variation,
      "Coefficient of variation of the moduli over space: standard deviation "
      "over mean; the mean is the value of the material. 0: uniform [-].",
      Patterns::Double(0., 1.));
    prm.add_parameter(
      "Strength variation",
      strength_variation,
      "Coefficient of variation of strengths, cohesion and tension cut-off, "
      "which are large where the moduli are. Friction and fracture energies "
      "are uniform [-].",
      Patterns::Double(0., 1.));
    prm.add_parameter(
      "Correlation lengths",
      lengths,
      "Distances in x, y and z at which the correlation of two points has "
      "fallen to 1/e [m].",
      Patterns::List(Patterns::Double(0.01, 1e5), 3, 3));
    prm.add_parameter("Seed",
                      seed,
                      "Start of the random numbers: another seed gives another "
                      "field of the same statistics.",
                      Patterns::Integer(0, 1000000000));
    prm.add_parameter(
      "Classes",
      n_classes,
      "Number of classes that the material is divided into, \"NAME 1\" the "
      "softest or weakest, with equal shares of the cells before refinement.",
      Patterns::Integer(2, 64));
    prm.add_parameter("Part",
                      part,
                      "Number of the class of this section, set by the program "
                      "in the file of the run; 0: all classes.",
                      Patterns::Integer(0, 64));
  }


  bool
  RandomFieldParameters::wanted() const
  {
    return part == 0 && (modulus_variation > 0. || strength_variation > 0.);
  }


  RandomField::RandomField(const std::vector<double> &lengths,
                           const unsigned int         seed)
    : waves(500)
  {
    std::mt19937_64 generator(seed);
    for (Wave &wave : waves)
      {
        for (unsigned int d = 0; d < 3; ++d)
          wave.vector[d] =
            numbers::SQRT2 / lengths[d] * quantile(normal, uniform(generator));
        wave.phase = 2. * numbers::PI * uniform(generator);
      }
  }


  double
  RandomField::operator()(const Point<3> &point) const
  {
    double sum = 0.;
    for (const Wave &wave : waves)
      sum += std::cos(wave.vector * point + wave.phase);
    return std::sqrt(2. / waves.size()) * sum;
  }


  unsigned int
  random_class(const double value, const unsigned int n_classes)
  {
    return std::min(static_cast<unsigned int>(cdf(normal, value) * n_classes),
                    n_classes - 1);
  }


  double
  factor_of_class(const unsigned int random_class,
                  const unsigned int n_classes,
                  const double       variation)
  {
    const double spread = std::sqrt(std::log1p(variation * variation)),
                 share  = 1. / n_classes;
    return (shifted_probability((random_class + 1) * share, spread) -
            shifted_probability(random_class * share, spread)) /
           share;
  }
} // namespace Voussoir
