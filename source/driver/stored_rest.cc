#include <voussoir/driver/stored_rest.h>
#include <voussoir/output/checkpoint.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    StateContent
    content_of(const Model &model, RestState &rest)
    {
      InitialState   &initial = rest.initial;
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
      for (unsigned int m = 0; m < model.solid.materials.size(); ++m)
        if (PointHistory *history = initial.material_memory.of(m))
          content
            .values["material " + model.parameters.materials.objects[m].first] =
            history->checkpoint_values();
      if (rest.contact)
        content.values["contact"] = rest.contact->checkpoint_values();
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
  store_rest(const Model          &model,
             const RestState      &rest,
             const std::string    &file,
             const nlohmann::json &identity)
  {
    RestState copy(rest);
    write_state(file,
                {{"identity", identity},
                 {"static state", rest.initial.displacement.size() > 0},
                 {"grouted", rest.initial.grouted_displacement.size() > 0},
                 {"contact force", rest.initial.contact_force.size() > 0},
                 {"contact",
                  rest.contact ? rest.contact->save() : nlohmann::json()},
                 {"summary", rest.summary}},
                content_of(model, copy),
                model.grid.communicator());
  }


  RestState
  read_rest(const Model &model, const std::string &file)
  {
    const MPI_Comm       communicator = model.grid.communicator();
    const nlohmann::json header       = read_state_header(file, communicator);
    RestState            rest(model);
    InitialState        &initial = rest.initial;
    if (header.at("static state"))
      initial.displacement = initial.temperature = initial.reaction =
        model.solid.discretization.create_vector();
    if (header.at("grouted"))
      initial.grouted_displacement = model.solid.discretization.create_vector();
    if (header.at("contact force"))
      initial.contact_force = model.solid.discretization.create_vector();

    StateContent content = content_of(model, rest);
    read_state(file, content, communicator);
    if (rest.contact)
      rest.contact->load(header.at("contact"));
    rest.summary = header.at("summary");
    return rest;
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
    modes.moving_mass = vector_of(header.at("moving mass"));
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
