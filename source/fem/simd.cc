#include <voussoir/fem/simd.h>

namespace Voussoir
{
  std::string
  simd_description()
  {
    return std::to_string(64 * Lanes::size()) + " bits (" +
           std::to_string(Lanes::size()) + " cells at a time" +
           (VOUSSOIR_SIMD_WIDENED ? ", widened over the packaged deal.II)" :
                                    ")");
  }
} // namespace Voussoir
