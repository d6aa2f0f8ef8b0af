#ifndef voussoir_fem_simd_h
#define voussoir_fem_simd_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/vectorization.h>

#include <cstdint>
#include <string>

namespace Voussoir
{
  /** The SIMD type of all cell work: one cell per lane. */
  using Lanes = dealii::VectorizedArray<double>;

  /** Strain or stress of one point, in each lane if Number is `Lanes`. */
  template <typename Number>
  using SymmetricTensor3 = dealii::SymmetricTensor<2, 3, Number>;

  /** The tensor whose six components (deal.II's order) are these numbers. */
  template <typename Number>
  SymmetricTensor3<Number>
  tensor_of(const Number *components)
  {
    SymmetricTensor3<Number> tensor;
    for (unsigned int i = 0; i < 6; ++i)
      tensor.access_raw_entry(i) = components[i];
    return tensor;
  }

  /** SIMD lanes of a number type, and access to one of them: where a law must
   *  be evaluated point by point. */
  template <typename Number>
  constexpr unsigned int
  n_lanes()
  {
    if constexpr (std::is_same_v<Number, double>)
      return 1;
    else
      return Number::size();
  }

  inline double &
  lane_of(double &number, const unsigned int)
  {
    return number;
  }

  inline const double &
  lane_of(const double &number, const unsigned int)
  {
    return number;
  }

  inline double &
  lane_of(Lanes &numbers, const unsigned int lane)
  {
    return numbers[lane];
  }

  inline const double &
  lane_of(const Lanes &numbers, const unsigned int lane)
  {
    return numbers[lane];
  }

  /** Whether any lane is above a limit. */
  template <typename Number>
  bool
  any_above(const Number &numbers, const double limit)
  {
    // as wide as the numbers, so that one instruction compares all lanes
    std::uint64_t any = 0;
    for (unsigned int lane = 0; lane < n_lanes<Number>(); ++lane)
      any |= std::uint64_t(lane_of(numbers, lane) > limit);
    return any != 0;
  }

  /** Width of `Lanes` in bits and whether it was widened beyond the packaged
   *  deal.II, for the start-up line. */
  std::string
  simd_description();
} // namespace Voussoir

#endif
