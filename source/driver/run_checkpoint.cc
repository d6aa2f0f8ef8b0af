// Checkpoints of a run and the way back from them.

#include <voussoir/base/mpi.h>
#include <voussoir/driver/run.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** The sums of energy that a run has made so far, each rank its own; a
     *  checkpoint holds those of all ranks together. */
    std::vector<double *>
    sums_of(State &state, WaterMotion *water)
    {
      EnergyAccounts       &a = state.accounts;
      std::vector<double *> sums{&a.work_of_forces,
                                 &a.loss_in_dashpots,
                                 &a.work_of_base,
                                 &a.work_of_projections,
                                 &a.loss_by_mass,
                                 &a.work_on_cells};
      if (water != nullptr)
        sums.push_back(&water->loss);
      return sums;
    }
  } // namespace


  std::map<std::string, Vector *>
  Run::checkpoint_vectors()
  {
    std::map<std::string, Vector *> vectors{{"displacement",
                                             &state.displacement},
                                            {"velocity", &state.velocity}};
    for (unsigned int i = 0; i < state.memory.size(); ++i)
      vectors["damping memory " + std::to_string(i)] = &state.memory[i];
    for (const auto &[name, observer] : model.parameters.observers)
      for (const auto &[vector_name, vector] : observer->checkpoint_vectors())
        vectors[name + "/" + vector_name] = vector;
    return vectors;
  }


  std::map<std::string, KeyedValues>
  Run::checkpoint_values()
  {
    std::map<std::string, KeyedValues> values;
    for (const auto &[name, observer] : model.parameters.observers)
      for (auto &[group_name, group] : observer->checkpoint_values())
        values[name + "/" + group_name] = std::move(group);
    for (unsigned int m = 0; m < model.materials.size(); ++m)
      if (PointHistory *history = state.material_memory.of(m))
        values["material " + model.parameters.materials.objects[m].first] =
          history->checkpoint_values();
    if (contact)
      values["contact"] = contact->checkpoint_values();
    if (water)
      {
        const auto keys = model.reservoir->space.node_keys();
        for (const auto &[name, vector] :
             std::map<std::string, Vector *>{{"pressure", &water->pressure},
                                             {"pressure impulse",
                                              &water->impulse}})
          {
            KeyedValues &group = values["reservoir/" + name];
            group.width        = 1;
            for (unsigned int i = 0; i < keys.size(); ++i)
              group.items.emplace_back(keys[i], vector->begin() + i);
          }
      }
    return values;
  }


  void
  Run::write_checkpoint()
  {
    TimerOutput::Scope scope(timer, "checkpoint");
    nlohmann::json     seen;
    for (const auto &[name, observer] : model.parameters.observers)
      seen[name] = observer->save();
    std::vector<double> work;
    for (const double *sum : sums_of(state, water.get()))
      work.push_back(*sum);
    const PointLosses losses = state.material_memory.losses();
    work.insert(work.end(), {losses.material, losses.closing});
    checkpoint.write(checkpoint_vectors(),
                     checkpoint_values(),
                     {{"time", state.time},
                      {"step", state.step},
                      {"time step", time_step.length},
                      {"energy", energy.save()},
                      {"work", sum_over_ranks(work, log.communicator())},
                      {"contact", contact ? contact->save() : nlohmann::json()},
                      {"observers", seen},
                      {"physics", folder.physics()}});
    log.line("Checkpoint written at t = ", state.time, " s");
    since_checkpoint.restart();
  }


  void
  Run::read_checkpoint()
  {
    const nlohmann::json &header = folder.checkpoint();
    checkpoint.read(checkpoint_vectors(), checkpoint_values());
    state.time = header.at("time");
    state.step = header.at("step");
    energy.load(header.at("energy"));
    for (unsigned int m = 0; m < model.materials.size(); ++m)
      if (PointHistory *history = state.material_memory.of(m))
        history->load();
    if (contact)
      contact->load(header.at("contact"));
    for (const auto &[name, observer] : model.parameters.observers)
      if (header.at("observers").contains(name))
        observer->load(header.at("observers").at(name));

    // sums are taken over the ranks: the first one gets all
    const std::vector<double> work = header.at("work");
    const bool                first =
      Utilities::MPI::this_mpi_process(log.communicator()) == 0;
    const auto sums = sums_of(state, water.get());
    for (unsigned int i = 0; i < sums.size(); ++i)
      *sums[i] = first ? work[i] : 0.;
    const unsigned int n = sums.size();
    state.material_memory.set_losses(first ? PointLosses{work[n], work[n + 1]} :
                                             PointLosses());

    // the free field has no checkpoint: it is marched again, which is cheap
    if (earthquake.wave)
      for (unsigned long long step = 0; step < state.step; ++step)
        earthquake.wave->replay(step * time_step.length);
    log.line("Going on from the checkpoint at t = ", state.time, " s");
  }
} // namespace Voussoir
