#include <voussoir/base/error.h>
#include <voussoir/driver/run_plan.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Refuses two constraints that prescribe the same component of a node.
    void
    refuse_contradictions(const NamedObjects<Projection>::List &constraints,
                          const MPI_Comm                        communicator)
    {
      std::map<std::pair<unsigned int, unsigned int>, unsigned int> first;
      unsigned int                                                  found = 0;
      for (unsigned int i = 0; i < constraints.size(); ++i)
        for (unsigned int d = 0; d < 3; ++d)
          if (constraints[i].second->prescribed_components()[d])
            for (const unsigned int node : constraints[i].second->nodes())
              if (const auto other = first.emplace(std::make_pair(node, d), i);
                  !other.second)
                found = std::max<unsigned int>(
                  found,
                  1 + d + 3 * (i + constraints.size() * other.first->second));
      found = Utilities::MPI::max(found, communicator);
      if (found == 0)
        return;
      const unsigned int pair = (found - 1) / 3;
      throw UserError(
        "The constraints \"" + constraints[pair / constraints.size()].first +
        "\" and \"" + constraints[pair % constraints.size()].first +
        "\" both prescribe the component " + "xyz"[(found - 1) % 3] +
        " of the same nodes; remove it from one of them by \"Components\", or "
        "name other faces.");
    }


    NamedObjects<Projection>::List
    made_constraints(const Model &model)
    {
      const Case &parameters = model.parameters;
      auto        list       = parameters.projections.make(parameters.file);
      for (auto &[name, constraint] : list)
        constraint->prepare(model.solid.discretization,
                            model.solid.mass,
                            parameters.file,
                            "Constraints/" + name);
      refuse_contradictions(list, model.grid.communicator());
      return list;
    }
  } // namespace


  RunPlan::RunPlan(const Model &model, Log &log)
    : model(model)
    , constraints(made_constraints(model))
    , observers(model.parameters.observers.make(model.parameters.file))
    , motion(model, log)
  {
    const ObservedModel seen  = observed(log);
    const auto         &added = model.parameters.added_observers;
    for (auto observer = observers.begin(); observer != observers.end();)
      try
        {
          observer->second->check(seen);
          ++observer;
        }
      catch (const UserError &error)
        {
          if (std::find(added.begin(), added.end(), observer->first) ==
              added.end())
            throw;
          log.line("note: not evaluated for the verdict: ",
                   observer->first,
                   ", because ",
                   error.what());
          observer = observers.erase(observer);
        }
  }


  ObservedModel
  RunPlan::observed(Log &log) const
  {
    return {model.solid,
            model.contact.get(),
            model.reservoir.get(),
            constraints,
            ResultNames(model.parameters.material_names(),
                        model.grid,
                        model.contact.get()),
            model.parameters.time.end_time,
            model.carried_frequency(),
            model.rigid_base(),
            log};
  }


  double
  RunPlan::record_interval() const
  {
    double      shortest = 0.;
    const auto &added    = model.parameters.added_observers;
    for (const auto &observer : observers)
      {
        // observers that are added for the verdict do not change the time step
        if (std::find(added.begin(), added.end(), observer.first) !=
            added.end())
          continue;
        const double interval = observer.second->record_interval();
        if (interval > 0. && (shortest == 0. || interval < shortest))
          shortest = interval;
      }
    return shortest;
  }
} // namespace Voussoir
