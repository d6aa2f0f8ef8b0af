#ifndef voussoir_tests_observed_h
#define voussoir_tests_observed_h

#include <voussoir/output/observer.h>

#include <filesystem>

#include "check.h"

namespace Voussoir
{
  /** An observer with some entries, and its results for some states. */
  inline nlohmann::json
  observed(const std::string                        &name,
           const std::map<std::string, std::string> &entries,
           const Simulation                         &simulation,
           const std::vector<State>                 &states)
  {
    const auto observer = Registry<Observer>::create(name, "the check");
    dealii::ParameterHandler prm;
    observer->declare_parameters(prm);
    for (const auto &[entry, value] : entries)
      prm.set(entry, value);
    ObservedRun model = simulation.run.observed;
    model.folder      = "observed";
    if (dealii::Utilities::MPI::this_mpi_process(
          simulation.model.grid.communicator()) == 0)
      std::filesystem::create_directories(model.folder);
    MPI_Barrier(simulation.model.grid.communicator());
    observer->check(model);
    observer->begin(model);
    for (const State &state : states)
      observer->observe(state);
    nlohmann::json summary;
    observer->finish(states.back(), summary);
    return summary[name];
  }
} // namespace Voussoir

#endif
