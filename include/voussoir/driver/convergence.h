#ifndef voussoir_driver_convergence_h
#define voussoir_driver_convergence_h

#include <array>
#include <optional>
#include <string>

namespace Voussoir
{
  /** Three sizes of cells or steps, or the numbers computed with them, the
   *  largest size first. */
  using ThreeSizes = std::array<double, 3>;

  /**
   * Richardson's extrapolation of a number to cells or steps of size zero.
   *
   * The number is taken as f(h) = f(0) + C h^p, whose three unknowns follow
   * from three sizes in any ratio (Celik et al. 2008, J. Fluids Eng. 130,
   * 078001). The band about the number of the smallest size is Roache's grid
   * convergence index, 1.25 times its distance from the extrapolated number.
   */
  struct Convergence
  {
    /** @param method_order theoretical order for smooth solutions */
    Convergence(const ThreeSizes &sizes,
                const ThreeSizes &values,
                const double      method_order);

    bool converges = false;

    /** "converges", "does not change", or the reason why there is no band. */
    std::string verdict;

    std::optional<double> order; // observed, if all changes have one sign
    std::optional<double> limit, band;
  };
} // namespace Voussoir

#endif
