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

  /** Whether single precision takes two batches of cells at a time, as it does
   *  unless a batch is one cell. */
  constexpr bool has_singles = Lanes::size() > 1;
  using Singles =
    std::conditional_t<has_singles,
                       dealii::VectorizedArray<float, 2 * Lanes::size()>,
                       dealii::VectorizedArray<float, 1>>;

  /** Strain or stress of one point, in each lane if Number is `Lanes`. */
  template <typename Number>
  using SymmetricTensor3 = dealii::SymmetricTensor<2, 3, Number>;

  /** The numbers of one batch in single precision. */
  typedef float HalfSingles
    __attribute__((vector_size(sizeof(float) * Lanes::size())));

  template <typename Double>
  HalfSingles
  rounded(const Double &numbers)
  {
    if constexpr (has_singles)
      return __builtin_convertvector(numbers.data, HalfSingles);
    else
      return HalfSingles();
  }

  template <std::size_t... lanes>
  Singles
  joined(const HalfSingles &first,
         const HalfSingles &second,
         const std::index_sequence<lanes...>)
  {
    Singles result = 0.f;
    if constexpr (sizeof...(lanes) > 2)
      result.data = __builtin_shufflevector(first, second, lanes...);
    return result;
  }

  /** The numbers of two batches. */
  inline Singles
  singles_of(const HalfSingles &first, const HalfSingles &second)
  {
    return joined(first, second, std::make_index_sequence<2 * Lanes::size()>());
  }

  inline Singles
  singles_of(const Lanes &first, const Lanes &second)
  {
    return singles_of(rounded(first), rounded(second));
  }

  /** The numbers of the first batch (@p half 0) or of the second one. */
  inline Lanes
  half_of_singles(const Singles &numbers, const unsigned int half)
  {
    Lanes result = 0.;
    if constexpr (has_singles)
      for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
        result[lane] = numbers[half * Lanes::size() + lane];
    return result;
  }

  inline SymmetricTensor3<Singles>
  singles_of(const SymmetricTensor3<Lanes> &first,
             const SymmetricTensor3<Lanes> &second)
  {
    SymmetricTensor3<Singles> result;
    for (unsigned int i = 0; i < 6; ++i)
      result.access_raw_entry(i) =
        singles_of(first.access_raw_entry(i), second.access_raw_entry(i));
    return result;
  }

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

  /** SIMD lanes of a number type, and access to one of them, for laws that are
   *  evaluated point by point. */
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

  template <typename Number, std::size_t width>
  Number &
  lane_of(dealii::VectorizedArray<Number, width> &numbers,
          const unsigned int                      lane)
  {
    return numbers[lane];
  }

  template <typename Number, std::size_t width>
  const Number &
  lane_of(const dealii::VectorizedArray<Number, width> &numbers,
          const unsigned int                            lane)
  {
    return numbers[lane];
  }

  inline dealii::SymmetricTensor<2, 3>
  lane_of(const SymmetricTensor3<Lanes> &tensor, const unsigned int lane)
  {
    dealii::SymmetricTensor<2, 3> one;
    for (unsigned int c = 0; c < 6; ++c)
      one.access_raw_entry(c) = tensor.access_raw_entry(c)[lane];
    return one;
  }

  /** Whether any lane is above a limit. */
  template <typename Number>
  bool
  any_above(const Number &numbers, const double limit)
  {
    // as wide as the numbers, so that one instruction compares all lanes
    using Real = std::decay_t<decltype(lane_of(std::declval<Number &>(), 0u))>;
    using Bits =
      std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
    Bits any = 0;
    for (unsigned int lane = 0; lane < n_lanes<Number>(); ++lane)
      any |= Bits(lane_of(numbers, lane) > Real(limit));
    return any != 0;
  }

  /** Width of `Lanes` in bits and whether it was widened beyond the packaged
   *  deal.II, for the start-up line. */
  std::string
  simd_description();
} // namespace Voussoir

#endif
