#include <voussoir/driver/stored_static_state.h>
#include <voussoir/output/checkpoint.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    StateContent
    content_of(const Model &model, StaticState &static_state)
    {
      InitialState   &initial = static_state.initial;
      const NodalKeys nodes(model.solid.discretization);
      StateContent    content;
      for (const auto &[name, vector] : std::map<std::string, Vector *>{
             {"displacement", &initial.displacement},
             {"grouted displacement", &initial.grouted_displacement},
             {"temperature", &initial.temperature},
             {"reaction", &initial.reaction},
             {"contact force", &initial.contact_force}})
        if (vector->size() > 0)
          content.values[name] = nodes.values(*vector);
      for (auto &[name, displacement] : initial.stages)
        content.values["displacement after " + name] =
          nodes.values(displacement);
      for (unsigned int m = 0; m < model.solid.materials.size(); ++m)
        if (PointHistory *history = initial.material_memory.of(m))
          content
            .values["material " + model.parameters.materials.objects[m].first] =
            history->checkpoint_values();
      if (static_state.contact)
        content.values["contact"] = static_state.contact->checkpoint_values();
      return content;
    }


    StateContent
    content_of(const Model &model, Modes &modes)
    {
      const NodalKeys nodes(model.solid.discretization);
      StateContent    content;
      for (unsigned int j = 0; j < modes.list.size(); ++j)
        content.values["mode " + std::to_string(j + 1)] =
          nodes.values(modes.list[j].shape);
      return content;
    }


    nlohmann::json
    numbers_of(const Tensor<1, 3> &vector)
    {
      return {vector[0], vector[1], vector[2]};
    }


    Tensor<1, 3>
    vector_of(const nlohmann::json &numbers)
    {
      return Tensor<1, 3>({numbers.at(0), numbers.at(1), numbers.at(2)});
    }
  } // namespace


  void
  store_static_state(const Model          &model,
                     const StaticState    &static_state,
                     const std::string    &file,
                     const nlohmann::json &identity)
  {
    StaticState    copy(static_state);
    nlohmann::json stages = nlohmann::json::array();
    for (const auto &stage : static_state.initial.stages)
      stages.push_back(stage.first);
    write_state(
      file,
      {{"identity", identity},
       {"static state", static_state.initial.displacement.size() > 0},
       {"stages", stages},
       {"grouted", static_state.initial.grouted_displacement.size() > 0},
       {"contact force", static_state.initial.contact_force.size() > 0},
       {"contact",
        static_state.contact ? static_state.contact->save() : nlohmann::json()},
       {"summary", static_state.summary}},
      content_of(model, copy),
      model.grid.communicator());
  }


  StaticState
  read_static_state(const Model &model, const std::string &file)
  {
    const MPI_Comm       communicator = model.grid.communicator();
    const nlohmann::json header       = read_state_header(file, communicator);
    StaticState          static_state(model);
    InitialState        &initial = static_state.initial;
    if (header.at("static state"))
      initial.displacement = initial.temperature = initial.reaction =
        model.solid.discretization.create_vector();
    if (header.at("grouted"))
      initial.grouted_displacement = model.solid.discretization.create_vector();
    for (const std::string stage : header.at("stages"))
      initial.stages.emplace_back(stage,
                                  model.solid.discretization.create_vector());
    if (header.at("contact force"))
      initial.contact_force = model.solid.discretization.create_vector();

    StateContent content = content_of(model, static_state);
    read_state(file, content, communicator);
    if (static_state.contact)
      static_state.contact->load(header.at("contact"));
    static_state.summary = header.at("summary");
    return static_state;
  }


  void
  store_modes(const Model &model, const Modes &modes, const std::string &file)
  {
    nlohmann::json list = nlohmann::json::array();
    for (const Mode &mode : modes.list)
      list.push_back({mode.frequency,
                      mode.mass,
                      mode.residual,
                      numbers_of(mode.participation),
                      numbers_of(mode.effective_mass)});
    Modes copy(modes);
    write_state(file,
                {{"moving mass", numbers_of(modes.moving_mass)},
                 {"measured shapes", modes.measured_shapes},
                 {"warnings", modes.warnings},
                 {"modes", list}},
                content_of(model, copy),
                model.grid.communicator());
  }


  Modes
  read_modes(const Model &model, const std::string &file)
  {
    const MPI_Comm       communicator = model.grid.communicator();
    const nlohmann::json header       = read_state_header(file, communicator);
    Modes                modes;
    modes.moving_mass     = vector_of(header.at("moving mass"));
    modes.measured_shapes = header.value("measured shapes", nlohmann::json());
    modes.warnings = header.value("warnings", std::vector<std::string>());
    for (const nlohmann::json &mode : header.at("modes"))
      modes.list.push_back({mode.at(0),
                            model.solid.discretization.create_vector(),
                            mode.at(1),
                            mode.at(2),
                            vector_of(mode.at(3)),
                            vector_of(mode.at(4))});
    StateContent content = content_of(model, modes);
    read_state(file, content, communicator);
    return modes;
  }
} // namespace Voussoir
