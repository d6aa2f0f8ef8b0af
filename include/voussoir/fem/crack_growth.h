#ifndef voussoir_fem_crack_growth_h
#define voussoir_fem_crack_growth_h

#include <voussoir/base/option.h>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  /** Where cracks begin, in cells and along interfaces. */
  enum class CrackGrowth
  {
    local,
    from_tips,
    along_planes
  };

  inline OptionNames<CrackGrowth>
  option_names(const CrackGrowth)
  {
    return {{CrackGrowth::local, "local"},
            {CrackGrowth::from_tips, "from tips"},
            {CrackGrowth::along_planes, "along planes"}};
  }


  /** Time steps after which new cracks are looked for. */
  constexpr unsigned int steps_between_looks = 4;


  /**
   * Factor on the strength ahead of a crack in cells of size h [m],
   *   1 / sqrt(1 + h / (E Gf / ft^2)) :
   * the cells average the stress at the tip, which for h above E Gf / ft^2
   * would let a crack run at too high a load.
   *
   * @param crack_length E Gf / ft^2 [m]
   */
  inline double
  strength_at_tip(const double cell_size, const double crack_length)
  {
    return 1. / std::sqrt(1. + cell_size / crack_length);
  }


  /**
   * Factor on the strength where a tip arrives. The stress may be higher
   * already; there the crack begins just below this stress, so that neither
   * energy nor stress jumps.
   *
   * @param at_tip factor at a tip
   * @param used   stress over the strength without a tip
   */
  template <typename Number>
  Number
  strength_where_tip_arrives(const Number &at_tip, const Number &used)
  {
    constexpr double just_below = 1. - 1e-9;
    return std::min(std::max(at_tip, Number(just_below * used)), Number(1.));
  }
} // namespace Voussoir

#endif
