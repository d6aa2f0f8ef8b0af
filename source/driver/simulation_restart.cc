// Checkpoints of a simulation and the way back from them.

#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/driver/simulation.h>

namespace Voussoir
{
  using namespace dealii;

  std::map<std::string, Vector *>
  Simulation::checkpoint_vectors()
  {
    std::map<std::string, Vector *> vectors{{"displacement",
                                             &state.displacement},
                                            {"velocity", &state.velocity}};
    for (unsigned int i = 0; i < state.memory.size(); ++i)
      vectors["damping memory " + std::to_string(i)] = &state.memory[i];
    for (const auto &[name, observer] : parameters.observers)
      for (const auto &[vector_name, vector] : observer->checkpoint_vectors())
        vectors[name + "/" + vector_name] = vector;
    return vectors;
  }


  std::map<std::string, KeyedValues>
  Simulation::checkpoint_values()
  {
    std::map<std::string, KeyedValues> values;
    for (const auto &[name, observer] : parameters.observers)
      for (auto &[group_name, group] : observer->checkpoint_values())
        values[name + "/" + group_name] = std::move(group);
    for (unsigned int m = 0; m < materials.size(); ++m)
      if (PointHistory *history = state.material_memory.of(m))
        values["material " + parameters.materials.objects[m].first] =
          history->checkpoint_values();
    if (contact)
      values["contact"] = contact->checkpoint_values();
    if (reservoir)
      {
        const auto keys = reservoir->space.node_keys();
        for (const auto &[name, vector] :
             std::map<std::string, Vector *>{{"pressure", &reservoir->pressure},
                                             {"pressure impulse",
                                              &reservoir->impulse}})
          {
            KeyedValues &group = values["reservoir/" + name];
            group.width        = 1;
            for (unsigned int i = 0; i < keys.size(); ++i)
              group.items.emplace_back(keys[i], vector->begin() + i);
          }
      }
    return values;
  }


  nlohmann::json
  Simulation::physics() const
  {
    // what must not change between a checkpoint and the run that goes on,
    // each as "Section/Entry = value"
    const std::set<std::string> free{"Title",
                                     "Mesh/Partition",
                                     "Time/End time"};
    std::ostringstream          text;
    parameters.prm.print_parameters(text, ParameterHandler::ShortText);
    nlohmann::json           result = nlohmann::json::array();
    std::istringstream       in(text.str());
    std::vector<std::string> sections;
    for (std::string line; std::getline(in, line);)
      {
        line              = Utilities::trim(line);
        const auto equals = line.find('=');
        if (line.rfind("subsection ", 0) == 0)
          sections.push_back(line.substr(11) + "/");
        else if (line == "end")
          sections.pop_back();
        else if (line.rfind("set ", 0) == 0)
          {
            const std::string entry =
              join(sections, "") + Utilities::trim(line.substr(4, equals - 4));
            if (free.count(entry) == 0 && entry.rfind("Output/", 0) != 0)
              result.push_back(entry + " =" + line.substr(equals + 1));
          }
      }
    return result;
  }


  void
  Simulation::write_checkpoint()
  {
    TimerOutput::Scope scope(timer, "checkpoint");
    nlohmann::json     seen;
    for (const auto &[name, observer] : parameters.observers)
      seen[name] = observer->save();
    checkpoint.write(checkpoint_vectors(),
                     checkpoint_values(),
                     {{"time", state.time},
                      {"step", state.step},
                      {"time step", time_step},
                      {"energy", energy.save()},
                      {"work", accumulated_work()},
                      {"contact", contact ? contact->save() : nlohmann::json()},
                      {"observers", seen},
                      {"physics", physics()}});
    log.line("Checkpoint written at t = ", state.time, " s");
    since_checkpoint.restart();
  }


  std::vector<double>
  Simulation::accumulated_work() const
  {
    return sum_over_ranks(
      std::vector<double>{terms.work_of_forces,
                          terms.loss_in_dashpots,
                          scheme.work_of_base,
                          scheme.work_of_projections,
                          scheme.loss_by_mass,
                          reservoir ? reservoir->loss : 0.,
                          state.material_memory.dissipated()},
      grid.communicator());
  }


  void
  Simulation::check_checkpoint()
  {
    if (!options.restart)
      return;
    const nlohmann::json header =
      Checkpoint::read_header(folder + "/checkpoint");
    const nlohmann::json mine = physics(), theirs = header.at("physics");
    const auto           line = [](const nlohmann::json &lines, std::size_t i) {
      return i < lines.size() ? Utilities::trim(lines[i].get<std::string>()) :
                                          std::string("nothing");
    };
    for (std::size_t i = 0; i < std::max(mine.size(), theirs.size()); ++i)
      if (line(mine, i) != line(theirs, i))
        throw UserError("The checkpoint in \"" + folder +
                        "\" was written with \"" + line(theirs, i) +
                        "\", the case now has \"" + line(mine, i) +
                        "\"; restart with the same physics, or start "
                        "afresh.");
    const double reached = header.at("time");
    if (reached >= parameters.time.end_time)
      {
        std::ostringstream text;
        text << "The checkpoint in \"" << folder << "\" is of " << reached
             << " s, but \"End time\" in section \"Time\" is "
             << parameters.time.end_time << " s; set a later one.";
        throw UserError(text.str());
      }
  }


  void
  Simulation::read_checkpoint()
  {
    const nlohmann::json header =
      Checkpoint::read_header(folder + "/checkpoint");
    checkpoint.read(checkpoint_vectors(), checkpoint_values());
    state.time = header.at("time");
    state.step = header.at("step");
    energy.load(header.at("energy"));
    for (unsigned int m = 0; m < materials.size(); ++m)
      if (PointHistory *history = state.material_memory.of(m))
        history->load();
    state.material_memory.set_dissipated(0.);
    if (contact)
      contact->load(header.at("contact"));
    for (const auto &[name, observer] : parameters.observers)
      if (header.at("observers").contains(name))
        observer->load(header.at("observers").at(name));
    const std::vector<double> work = header.at("work");
    if (Utilities::MPI::this_mpi_process(grid.communicator()) == 0)
      {
        terms.work_of_forces       = work[0];
        terms.loss_in_dashpots     = work[1];
        scheme.work_of_base        = work[2];
        scheme.work_of_projections = work[3];
        scheme.loss_by_mass        = work[4];
        if (reservoir)
          reservoir->loss = work[5];
        state.material_memory.set_dissipated(work[6]);
      }
    // the free field has no checkpoint: it is marched again, which is cheap
    for (unsigned long long step = 0; step < state.step; ++step)
      boundary.replay(step * time_step);
    log.line("Going on from the checkpoint at t = ", state.time, " s");
  }
} // namespace Voussoir
