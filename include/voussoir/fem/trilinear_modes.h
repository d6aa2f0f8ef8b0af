#ifndef voussoir_fem_trilinear_modes_h
#define voussoir_fem_trilinear_modes_h

#include <deal.II/base/tensor.h>

#include <array>

namespace Voussoir
{
  /**
   * Modes of a trilinear function of the unit coordinates xi_k from -1 to 1,
   *   u = u_0 + sum_k u_k xi_k + sum_k v_k xi_l xi_m + v_3 xi_0 xi_1 xi_2 ,
   * where l and m are the directions beside k. They are in the order of these
   * products: bit k of an index is set where xi_k is a factor.
   */
  namespace TrilinearModes
  {
    // Places of u_k and v_k among the modes.
    constexpr unsigned int linear[3]    = {1, 2, 4};
    constexpr unsigned int hourglass[4] = {6, 5, 3, 7};

    /** Eight times the parts u_0, u_k, v_k of a function from its corner
     * values.
     */
    template <typename Number>
    void
    to_modes(Number *values)
    {
      for (const unsigned int bit : {1, 2, 4})
        for (unsigned int v = 0; v < 8; ++v)
          if ((v & bit) == 0)
            {
              const Number low = values[v], high = values[v | bit];
              values[v]       = low + high;
              values[v | bit] = high - low;
            }
    }

    /** The same, in registers: stores take twice the time of loads. */
    template <typename Number>
    void
    to_modes(const Number *values, std::array<Number, 8> &modes)
    {
      for (unsigned int v = 0; v < 8; ++v) // std::copy goes through memory
        modes[v] = values[v];
      to_modes(modes.data());
    }

    /** The transpose of `to_modes`. */
    template <typename Number>
    void
    to_corners(Number *values)
    {
      for (const unsigned int bit : {1, 2, 4})
        for (unsigned int v = 0; v < 8; ++v)
          if ((v & bit) == 0)
            {
              const Number even = values[v], odd = values[v | bit];
              values[v]       = even - odd;
              values[v | bit] = even + odd;
            }
    }

    /** One mode of the three components of a displacement. */
    template <typename Number>
    dealii::Tensor<1, 3, Number>
    mode(const Number *values, const unsigned int index)
    {
      dealii::Tensor<1, 3, Number> result;
      for (unsigned int d = 0; d < 3; ++d)
        result[d] = values[8 * d + index];
      return result;
    }
  } // namespace TrilinearModes
} // namespace Voussoir

#endif
