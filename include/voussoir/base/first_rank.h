#ifndef voussoir_base_first_rank_h
#define voussoir_base_first_rank_h

#include <voussoir/base/error.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <string>
#include <vector>

namespace Voussoir
{
  /** Runs an action on the first rank; all ranks throw its exceptions. */
  template <typename Action>
  void
  on_first_rank(const MPI_Comm communicator, const Action &action)
  {
    std::string problem;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      try
        {
          action();
        }
      catch (const UserError &error)
        {
          problem = error.what();
        }
    problem = dealii::Utilities::MPI::broadcast(communicator, problem);
    if (!problem.empty())
      throw UserError(problem);
  }


  /**
   * What @p make makes for the number of this rank, on the first rank, which
   * sends it. The first rank stores one of these at a time. Only the
   * @p make of the first rank is called.
   */
  template <typename Make>
  auto
  made_on_first_rank(const MPI_Comm communicator, const Make &make)
    -> decltype(make(0U))
  {
    namespace MPI = dealii::Utilities::MPI;
    using Object  = decltype(make(0U));
    // in one piece, which may have more bytes than an int counts
    const auto as_one = [](const unsigned long long n_bytes) {
      return MPI::create_mpi_data_type_n_bytes(n_bytes);
    };
    constexpr int of_size = 0, of_data = 1; // tags
    if (MPI::this_mpi_process(communicator) > 0)
      {
        unsigned long long size = 0;
        MPI_Recv(&size,
                 1,
                 MPI_UNSIGNED_LONG_LONG,
                 0,
                 of_size,
                 communicator,
                 MPI_STATUS_IGNORE);
        std::vector<char> data(size);
        MPI_Recv(data.data(),
                 1,
                 *as_one(size),
                 0,
                 of_data,
                 communicator,
                 MPI_STATUS_IGNORE);
        return dealii::Utilities::unpack<Object>(data, false);
      }
    for (unsigned int rank = 1; rank < MPI::n_mpi_processes(communicator);
         ++rank)
      {
        const std::vector<char> data =
          dealii::Utilities::pack(make(rank), false);
        const unsigned long long size = data.size();
        MPI_Send(&size, 1, MPI_UNSIGNED_LONG_LONG, rank, of_size, communicator);
        MPI_Send(data.data(), 1, *as_one(size), rank, of_data, communicator);
      }
    return make(0U);
  }
} // namespace Voussoir

#endif
