#ifndef voussoir_fem_rounding_h
#define voussoir_fem_rounding_h

#include <voussoir/fem/simd.h>

#include <cmath>

namespace Voussoir
{
  /**
   * Makes sums over cells independent of their order, bit for bit: each part is
   * rounded to a multiple of one quantum beforehand, so that sums of less than
   * 2^53 quanta are exact (the pre-rounding of Demmel and Nguyen 2013). Parts
   * take up to 47 bits, which leaves six for the number of parts that meet in a
   * node.
   */
  class Rounding
  {
  public:
    /** @param limit of the amount of each part, the same on all ranks */
    explicit Rounding(const double limit)
    {
      int exponent;
      std::frexp(limit, &exponent);
      shift = std::ldexp(1.5, exponent - 47 + 52);
      bound = std::ldexp(1., exponent);
    }

    void
    operator()(Lanes *parts, const unsigned int n)
    {
      // kept in registers: the compiler cannot exclude that parts are members
      const Lanes by   = shift;
      Lanes       most = largest;
      for (unsigned int i = 0; i < n; ++i)
        {
          most     = std::max(most, std::abs(parts[i]));
          parts[i] = (parts[i] + by) - by;
        }
      largest = most;
    }

    /** The same for entries of a vector. */
    void
    operator()(double *begin, double *end)
    {
      constexpr std::ptrdiff_t at_once = Lanes::size();
      for (; end - begin >= at_once; begin += at_once)
        {
          Lanes parts;
          parts.load(begin);
          (*this)(&parts, 1);
          parts.store(begin);
        }
      Lanes rest = 0.;
      std::copy(begin, end, rest.begin());
      (*this)(&rest, 1);
      std::copy_n(rest.begin(), end - begin, begin);
    }

    /** Whether a part of this rank was above the limit, so that sums may have
     *  been rounded. */
    bool
    exceeded() const
    {
      for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
        if (!(largest[lane] <= bound))
          return true;
      return false;
    }

  private:
    Lanes  shift, largest = 0.;
    double bound;
  };
} // namespace Voussoir

#endif
