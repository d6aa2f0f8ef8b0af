#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/version.h>
#include <voussoir/driver/case_identity.h>
#include <voussoir/driver/run_checkpoints.h>
#include <voussoir/fem/nodal_values.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Identifier of a mesh, the same for all partitions. */
    nlohmann::json
    mesh_identity(const Model &model)
    {
      const Discretization &discretization = model.solid.discretization;
      double                sum            = 0.;
      for (const auto &cell :
           discretization.dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          sum += static_cast<double>(Grid::global_key(cell) % 1000003);
      return {{"unknowns", discretization.dof_handler.n_dofs()},
              {"sum of cells",
               Utilities::MPI::sum(sum, model.grid.communicator())}};
    }
  } // namespace


  RunCheckpoints::RunCheckpoints(RunSetup           &setup,
                                 const ResultFolder &folder,
                                 Contact            *contact,
                                 Log                &log)
    : setup(setup)
    , model(setup.model)
    , folder(folder)
    , contact(contact)
    , log(log)
    , files(folder.checkpoints(), log.communicator())
    , n_warnings_before(log.warnings().size())
    , by_time(model.parameters.output.checkpoint_time > 0.)
    , schedule(model.parameters.output.checkpoint_time, setup.time_step.length)
  {}


  bool
  RunCheckpoints::are_due(const unsigned long long step) const
  {
    return by_time && schedule.due(step);
  }


  // Energies summed up so far, each rank its own part.
  std::vector<Sum *>
  RunCheckpoints::sums_of_rank(State &state) const
  {
    EnergyAccounts    &a = state.accounts;
    std::vector<Sum *> sums{&a.work_of_forces,
                            &a.loss_in_dashpots,
                            &a.work_of_base,
                            &a.work_of_projections,
                            &a.loss_by_mass};
    for (unsigned int m = 0; m < model.solid.materials.size(); ++m)
      if (PointHistory *history = state.material_memory.of(m))
        sums.insert(sums.end(),
                    {&history->losses.material,
                     &history->losses.closing,
                     &history->losses.damping});
    return sums;
  }


  std::vector<double *>
  RunCheckpoints::plain_sums_of_rank() const
  {
    std::vector<double *> sums;
    if (setup.water)
      sums.push_back(&setup.water->loss);
    if (contact)
      for (double *energy : contact->energies())
        sums.push_back(energy);
    return sums;
  }


  StateContent
  RunCheckpoints::content_of(State &state) const
  {
    const NodalKeys nodes(model.solid.discretization);
    StateContent    content;
    auto           &values = content.values;
    values["displacement"] = nodes.values(state.displacement);
    values["velocity"]     = nodes.values(state.velocity);
    for (unsigned int i = 0; i < state.memory.size(); ++i)
      values["damping memory " + std::to_string(i)] =
        nodes.values(state.memory[i]);
    for (const auto &[name, observer] : setup.plan.observers)
      {
        for (const auto &[own_name, vector] : observer->checkpoint_vectors())
          values[name + "/" + own_name] = nodes.values(*vector);
        for (auto &[own_name, group] : observer->checkpoint_values())
          values[name + "/" + own_name] = std::move(group);
      }
    for (unsigned int m = 0; m < model.solid.materials.size(); ++m)
      if (PointHistory *history = state.material_memory.of(m))
        values["material " + model.parameters.materials.objects[m].first] =
          history->checkpoint_values();
    if (contact)
      values["contact"] = contact->checkpoint_values();
    if (setup.water)
      {
        const auto keys = model.reservoir->space.node_keys();
        for (const auto &[name, vector] : std::map<std::string, Vector *>{
               {"pressure", &setup.water->pressure},
               {"pressure impulse", &setup.water->impulse}})
          {
            KeyedValues &group = values["reservoir/" + name];
            group.width        = 1;
            for (unsigned int i = 0; i < keys.size(); ++i)
              group.items.emplace_back(keys[i], vector->begin() + i);
          }
      }
    content.documents = {{"observers", nullptr},
                         {"free field", nullptr},
                         {"radiating end", nullptr},
                         {"sums of ranks", nullptr}};
    return content;
  }


  nlohmann::json
  RunCheckpoints::sizes_of_files() const
  {
    nlohmann::json sizes = nlohmann::json::object();
    for (const auto &[name, size] : log.sizes_of_growing_files())
      sizes[name.substr(folder.path().size() + 1)] = size;
    return sizes;
  }


  std::vector<std::string>
  RunCheckpoints::warnings_of_run() const
  {
    return {log.warnings().begin() + n_warnings_before, log.warnings().end()};
  }


  bool
  RunCheckpoints::write(State &state, const EnergyBalance &energy) const
  {
    if (!std::isfinite(largest_amount(state.velocity)))
      return false; // a run with infinite energies stops at the next line of
                    // the energy balance
    StateContent content = content_of(state);
    for (const auto &[name, observer] : setup.plan.observers)
      content.documents["observers"][name] = observer->save();
    if (setup.earthquake.wave)
      content.documents["free field"] = setup.earthquake.wave->save();
    if (setup.water && setup.water->end)
      content.documents["radiating end"] = setup.water->end->save();
    std::vector<double> sums;
    for (const Sum *sum : sums_of_rank(state))
      for (const double number : sum->save())
        sums.push_back(number);
    for (const double *sum : plain_sums_of_rank())
      sums.push_back(*sum);
    content.documents["sums of ranks"] =
      Utilities::MPI::all_gather(log.communicator(), sums);
    try
      {
        // a run that continues from here does not repeat their lines
        if (!log.write_growing_files())
          throw UserError("some of the results cannot be written.");
        files.write(state.step,
                    {{"version", version()},
                     {"identity", identity_of(model.parameters)},
                     {"mesh", mesh_identity(model)},
                     {"time", state.time},
                     {"step", state.step},
                     {"time step", setup.time_step.length},
                     {"earthquake followed to", setup.plan.motion.followed_to},
                     {"energy", energy.save()},
                     {"contact", contact ? contact->save() : nlohmann::json()},
                     {"sizes of files", sizes_of_files()},
                     {"warnings", warnings_of_run()}},
                    content);
      }
    catch (const UserError &error)
      {
        log.warn("no checkpoint at t = ", state.time, " s: ", error.what());
        return false;
      }
    log.line("Checkpoint written at t = ", state.time, " s");
    return true;
  }


  void
  RunCheckpoints::read(State &state, EnergyBalance &energy) const
  {
    const nlohmann::json &header = folder.checkpoint();
    if (header.at("mesh") != mesh_identity(model))
      throw UserError("The checkpoint \"" + folder.checkpoint_file() +
                      "\" belongs to another mesh; restart with the mesh, "
                      "degree and refinement of the run that wrote it.");
    if (const double followed_to = header.at("earthquake followed to");
        followed_to != setup.plan.motion.followed_to)
      {
        std::ostringstream text;
        text << "The checkpoint \"" << folder.checkpoint_file()
             << "\" is of a motion without end, given at the free surface and "
                "deconvolved to the base for "
             << followed_to
             << " s; keep this \"End time\" in section \"Time\", or start "
                "afresh.";
        throw UserError(text.str());
      }
    if (header.at("version") != version())
      log.warn("the run until t = ",
               header.at("time").get<double>(),
               " s was made by another version, ",
               header.at("version").get<std::string>());
    for (const nlohmann::json &warning : header.at("warnings"))
      log.warn(warning.get<std::string>());

    StateContent content = content_of(state);
    read_state(folder.checkpoint_file(), content, log.communicator());
    state.time = header.at("time");
    state.step = header.at("step");
    energy.load(header.at("energy"));
    if (contact)
      contact->load(header.at("contact"));
    const nlohmann::json &seen = content.documents["observers"];
    for (const auto &[name, observer] : setup.plan.observers)
      observer->load(seen.at(name));
    if (setup.earthquake.wave)
      setup.earthquake.wave->load(content.documents["free field"]);
    if (setup.water && setup.water->end)
      setup.water->end->load(content.documents["radiating end"]);

    // with the same number of ranks each takes its own part, so that round-off
    // is the same; else the first rank takes all
    const std::vector<std::vector<double>> of_ranks =
      content.documents["sums of ranks"];
    const unsigned int rank =
      Utilities::MPI::this_mpi_process(log.communicator());
    const bool same_ranks =
      of_ranks.size() == Utilities::MPI::n_mpi_processes(log.communicator());
    unsigned int i = 0;
    const auto   for_each_of_mine =
      [&](const std::function<void(const std::vector<double> &)> &take) {
        for (unsigned int r = 0; r < of_ranks.size(); ++r)
          if (same_ranks ? r == rank : rank == 0)
            take(of_ranks[r]);
      };
    for (Sum *const sum : sums_of_rank(state))
      {
        sum->clear();
        for_each_of_mine([&](const std::vector<double> &numbers) {
          std::vector<double> saved;
          for (unsigned int k = 0; k < sum->n_saved(); ++k)
            saved.push_back(numbers.at(i + k));
          sum->add_saved(saved);
        });
        i += sum->n_saved();
      }
    for (double *const sum : plain_sums_of_rank())
      {
        *sum = 0.;
        for_each_of_mine(
          [&](const std::vector<double> &numbers) { *sum += numbers.at(i); });
        ++i;
      }
    log.line("Continuing from the checkpoint \"",
             folder.checkpoint_file(),
             "\" at t = ",
             state.time,
             " s");
  }
} // namespace Voussoir
