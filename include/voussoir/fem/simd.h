#ifndef voussoir_fem_simd_h
#define voussoir_fem_simd_h

#include <deal.II/base/vectorization.h>

#include <string>

namespace Voussoir
{
  /** The SIMD type of all cell work: one cell per lane. */
  using Lanes = dealii::VectorizedArray<double>;

  /** Width of `Lanes` in bits and whether it was widened beyond the packaged
   *  deal.II, for the start-up line. */
  std::string
  simd_description();
} // namespace Voussoir

#endif
