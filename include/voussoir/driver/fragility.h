#ifndef voussoir_driver_fragility_h
#define voussoir_driver_fragility_h

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace Voussoir
{
  /** Runs at one intensity of the motion, and how many meet a criterion. */
  struct IntensityLevel
  {
    double       intensity;
    unsigned int n_runs, n_met;
  };

  /** With bounds of the confidence that was asked for. */
  struct BoundedEstimate
  {
    double value, lower, upper;
  };

  /**
   * The probability Phi(ln(intensity / median) / dispersion) that a criterion
   * is met, by maximum likelihood (Baker 2015, Earthquake Spectra 31, 579-599):
   * the runs at each level are independent trials. Confidence bounds are those
   * of Fisher's information on the logarithms of both.
   */
  struct FragilityCurve
  {
    /** @param confidence of the bounds, as 0.9 */
    FragilityCurve(const std::vector<IntensityLevel> &levels,
                   const double                       confidence);

    /** Of a curve that was found. */
    double
    probability(const double intensity) const;

    std::string                    verdict; // "found", or why it was not
    std::optional<BoundedEstimate> median, dispersion;
  };
} // namespace Voussoir

#endif
