#ifndef voussoir_base_sum_h
#define voussoir_base_sum_h

#include <deal.II/base/mpi.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace Voussoir
{
  /**
   * A sum of doubles, in floating-point arithmetic or exact. The exact sum
   * takes each term as a multiple of 2^-62 and depends neither on the order of
   * the terms nor on their distribution over the ranks; its terms are below
   * 2^52 and the sum below 2^53.
   */
  class Sum
  {
  public:
    Sum() = default;

    explicit Sum(const bool exact)
      : exact(exact)
    {}

    Sum &
    operator+=(const double term)
    {
      if (!exact)
        plain += term;
      else if (std::abs(term) < 0x1p52)
        {
          const auto multiple = static_cast<std::int64_t>(term * 0x1p10);
          whole += multiple;
          rest += static_cast<std::int64_t>(
            (term - static_cast<double>(multiple) * 0x1p-10) * 0x1p62);
          carry();
        }
      else
        ++beyond;
      return *this;
    }

    Sum &
    operator-=(const double term)
    {
      return *this += -term;
    }

    Sum &
    operator+=(const Sum &other)
    {
      exact = exact || other.exact;
      plain += other.plain;
      whole += other.whole;
      rest += other.rest;
      beyond += other.beyond;
      carry();
      return *this;
    }

    Sum &
    operator-=(const Sum &other)
    {
      exact = exact || other.exact;
      plain -= other.plain;
      whole -= other.whole;
      rest -= other.rest;
      beyond += other.beyond;
      carry();
      return *this;
    }

    /** NaN if the sum is exact and a term was NaN or too large. */
    operator double() const
    {
      if (!exact)
        return plain;
      return beyond > 0 ? std::numeric_limits<double>::quiet_NaN() :
                          static_cast<double>(whole) * 0x1p-10 +
                            static_cast<double>(rest) * 0x1p-62;
    }

    bool
    is_exact() const
    {
      return exact;
    }

    /** Resets the sum to zero. */
    void
    clear()
    {
      *this = Sum(exact);
    }

    /** Number of values that `save` returns. */
    unsigned int
    n_saved() const
    {
      return exact ? 5 : 1;
    }

    /** State of the sum, in numbers that a double represents exactly. */
    std::vector<double>
    save() const
    {
      if (!exact)
        return {plain};
      return {plain,
              static_cast<double>(whole >> 32),
              static_cast<double>(whole & 0xffffffff),
              static_cast<double>(rest),
              static_cast<double>(beyond)};
    }

    /** Adds a state that `save` returned. */
    void
    add_saved(const std::vector<double> &saved)
    {
      plain += saved.at(0);
      if (!exact)
        return;
      whole += (static_cast<std::int64_t>(saved.at(1)) << 32) +
               static_cast<std::int64_t>(saved.at(2));
      rest += static_cast<std::int64_t>(saved.at(3));
      beyond += static_cast<std::int64_t>(saved.at(4));
      carry();
    }

    friend std::vector<double>
    sum_over_ranks(const std::vector<Sum> &sums, const MPI_Comm communicator);

  private:
    void
    carry()
    {
      whole += rest >> 52;
      rest &= (std::int64_t(1) << 52) - 1;
    }

    bool         exact  = false;
    double       plain  = 0.;
    std::int64_t whole  = 0; // multiples of 2^-10
    std::int64_t rest   = 0; // of 2^-62, less than one of 2^-10
    std::int64_t beyond = 0; // terms that could not be added
  };


  /** Sums of equally long lists, entry by entry. */
  inline std::vector<double>
  sum_over_ranks(const std::vector<Sum> &sums, const MPI_Comm communicator)
  {
    using dealii::Utilities::MPI::sum;
    std::vector<double>       plain;
    std::vector<std::int64_t> parts;
    for (const Sum &one : sums)
      {
        plain.push_back(one.plain);
        parts.insert(parts.end(), {one.whole, one.rest, one.beyond});
      }
    sum(plain, communicator, plain);
    if (sums.empty() || !sums[0].is_exact())
      return plain;
    sum(parts, communicator, parts);
    for (std::size_t i = 0; i < sums.size(); ++i)
      {
        Sum total(true);
        total.whole  = parts[3 * i];
        total.rest   = parts[3 * i + 1];
        total.beyond = parts[3 * i + 2];
        total.carry();
        plain[i] = total;
      }
    return plain;
  }
} // namespace Voussoir

#endif
