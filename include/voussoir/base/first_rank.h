#ifndef voussoir_base_first_rank_h
#define voussoir_base_first_rank_h

#include <voussoir/base/error.h>

#include <deal.II/base/mpi.h>

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
} // namespace Voussoir

#endif
