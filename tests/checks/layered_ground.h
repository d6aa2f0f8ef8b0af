#ifndef voussoir_tests_layered_ground_h
#define voussoir_tests_layered_ground_h

#include <complex>

#include "check.h"

namespace Voussoir
{
  /**
   * Horizontal layers under a vertically rising plane wave, in closed form
   * (Haskell's matrices; Kramer 1996, section 7.2), over the complex frequency
   * s. Damping follows from the entries of the case: under Maxwell damping the
   * modulus of a constant ratio xi (Kjartansson 1979), (s/w0)^(2 gamma) /
   * cos(pi gamma), gamma = atan(2 xi) / pi.
   */
  class LayeredGround
  {
  public:
    /** @p thicknesses [m] from below, in the order of the materials */
    LayeredGround(const Case                &parameters,
                  const std::vector<double> &thicknesses)
      : damping(parameters.damping)
      , thicknesses(thicknesses)
    {
      for (const Material *material : parameters.material_list())
        materials.push_back(material->elastic_constants());
      AssertThrow(materials.size() == thicknesses.size(),
                  dealii::ExcMessage("a thickness for each material"));
    }

    /** Displacement of the surface over that of the outcrop, which
     *  is twice the incident wave at the base. */
    std::complex<double>
    surface_over_outcrop(const std::complex<double> s, const bool p_wave) const
    {
      // from displacement 1 and no stress at the surface, downwards
      std::complex<double> displacement = 1., stress = 0.;
      for (unsigned int i = materials.size(); i-- > 0;)
        {
          const std::complex<double> modulus = materials[i].density *
                                               squared_speed(i, p_wave) *
                                               relative_modulus(s);
          const std::complex<double> k =
            s * std::sqrt(materials[i].density * relative_density(s) / modulus);
          const std::complex<double> c     = std::cosh(k * thicknesses[i]),
                                     sh    = std::sinh(k * thicknesses[i]);
          const std::complex<double> above = displacement;
          displacement = above * c + stress / (modulus * k) * sh;
          stress       = above * modulus * k * sh + stress * c;
        }
      // the traction on the base is rho c (2 v_incident - v)
      return 1. /
             (displacement + stress / (s * materials[0].density *
                                       std::sqrt(squared_speed(0, p_wave))));
    }

    /**
     * Compares a motion of the surface with that of the outcrop, both sampled
     * at these times, at frequencies [Hz]. Both are weighted by exp(-8 t/T),
     * which is a shift of the complex frequency, so that oscillations after the
     * end T do not matter.
     */
    void
    compare(const std::string         &name,
            const bool                 p_wave,
            const std::vector<double> &times,
            const std::vector<double> &surface,
            const std::vector<double> &outcrop,
            const std::vector<double> &frequencies,
            const double               tolerance,
            Verdicts                  &verdicts) const
    {
      for (const double frequency : frequencies)
        {
          const std::complex<double> s(8. / times.back(),
                                       2. * dealii::numbers::PI * frequency);
          std::complex<double>       above, below;
          for (std::size_t i = 0; i < times.size(); ++i)
            {
              above += surface[i] * std::exp(-s * times[i]);
              below += outcrop[i] * std::exp(-s * times[i]);
            }
          std::ostringstream text;
          text << name << " at " << frequency << " Hz";
          const std::complex<double> expected = surface_over_outcrop(s, p_wave);
          verdicts.near(text.str() + ": surface over outcrop",
                        std::abs(above / below),
                        std::abs(expected),
                        tolerance);
          verdicts.below(text.str() + ": angle between them, less expected",
                         std::arg(above / below / expected),
                         tolerance);
        }
    }

  private:
    double
    squared_speed(const unsigned int material, const bool p_wave) const
    {
      const double c = p_wave ? materials[material].p_wave_speed() :
                                materials[material].s_wave_speed();
      return c * c;
    }

    /** Modulus over that at the reference frequency. */
    std::complex<double>
    relative_modulus(const std::complex<double> s) const
    {
      if (damping.model == DampingModel::rayleigh)
        return 1. + 2. * damping.ratio / (low() + high()) * s;
      if (damping.model != DampingModel::maxwell)
        return 1.;
      const double gamma = std::atan(2. * damping.ratio) / dealii::numbers::PI;
      return std::pow(s / (2. * dealii::numbers::PI *
                           std::stod(damping.reference)),
                      2. * gamma) /
             std::cos(dealii::numbers::PI * gamma);
    }

    std::complex<double>
    relative_density(const std::complex<double> s) const
    {
      return damping.model == DampingModel::rayleigh ?
               1. + 2. * damping.ratio * low() * high() / (low() + high()) / s :
               1.;
    }

    double
    low() const
    {
      return 2. * dealii::numbers::PI * damping.lowest_frequency;
    }

    double
    high() const
    {
      return 2. * dealii::numbers::PI * damping.highest_frequency;
    }

    const DampingParameters       damping;
    const std::vector<double>     thicknesses;
    std::vector<ElasticConstants> materials;
  };
} // namespace Voussoir

#endif
