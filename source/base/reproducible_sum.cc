#include <voussoir/base/mpi.h>
#include <voussoir/base/reproducible_sum.h>

#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  double
  reproducible_sum(const std::vector<double> &terms,
                   const MPI_Comm             communicator)
  {
    constexpr unsigned int n_groups = 3, digits = 20;
    double                 largest = 0.;
    for (const double term : terms)
      largest = std::max(largest, std::abs(term));
    largest = Utilities::MPI::max(largest, communicator);
    if (!(largest > 0.) || !std::isfinite(largest))
      return largest;

    int exponent;
    std::frexp(largest, &exponent);
    std::vector<double> shift, sums(n_groups);
    for (unsigned int g = 1; g <= n_groups; ++g)
      shift.push_back(
        std::ldexp(1.5, exponent - static_cast<int>(g * digits) + 52));
    for (double rest : terms)
      for (unsigned int g = 0; g < n_groups; ++g)
        {
          const double part = (rest + shift[g]) - shift[g];
          sums[g] += part;
          rest -= part;
        }
    sums = sum_over_ranks(sums, communicator);
    return sums[0] + (sums[1] + sums[2]);
  }
} // namespace Voussoir
