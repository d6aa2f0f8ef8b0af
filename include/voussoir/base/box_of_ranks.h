#ifndef voussoir_base_box_of_ranks_h
#define voussoir_base_box_of_ranks_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/point.h>

#include <algorithm>

namespace Voussoir
{
  /** The box around points of one rank, and then of all ranks [m]. */
  struct BoxOfRanks
  {
    dealii::Point<3> lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};

    void
    add(const dealii::Point<3> &point)
    {
      for (unsigned int d = 0; d < 3; ++d)
        {
          lower[d] = std::min(lower[d], point[d]);
          upper[d] = std::max(upper[d], point[d]);
        }
    }

    void
    join(const MPI_Comm communicator)
    {
      for (unsigned int d = 0; d < 3; ++d)
        {
          lower[d] = dealii::Utilities::MPI::min(lower[d], communicator);
          upper[d] = dealii::Utilities::MPI::max(upper[d], communicator);
        }
    }
  };
} // namespace Voussoir

#endif
