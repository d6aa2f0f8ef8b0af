#ifndef voussoir_driver_fragility_h
#define voussoir_driver_fragility_h

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace Voussoir
{
  /** Numbers of runs at one intensity of the motion, and of those that meet a
   *  criterion. */
  struct IntensityLevel
  {
    double       intensity;
    unsigned int n_runs, n_met;
  };

  /** An estimate with its confidence bounds. */
  struct BoundedEstimate
  {
    double value, lower, upper;
  };

  /**
   * The probability Phi(ln(intensity / median) / dispersion) that a criterion
   * is met, by maximum likelihood (Baker 2015, Earthquake Spectra 31, 579-599):
   * the runs at each level are independent trials. Confidence bounds follow
   * from Fisher's information for the logarithms of median and dispersion.
   */
  struct FragilityCurve
  {
    /** @param confidence of the bounds, as 0.9 */
    FragilityCurve(const std::vector<IntensityLevel> &levels,
                   const double                       confidence);

    /** The probability, if the curve was found. */
    double
    probability(const double intensity) const;

    std::string                    verdict; // "found", or the reason why not
    std::optional<BoundedEstimate> median, dispersion;
  };
} // namespace Voussoir

#endif
