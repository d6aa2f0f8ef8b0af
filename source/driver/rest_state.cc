#include <voussoir/driver/rest_state.h>

namespace Voussoir
{
  RestState::RestState(const Model &model)
  {
    initial.material_memory = model.internal_force.new_memory();
    if (model.contact)
      contact.emplace(*model.contact);
  }


  RestState
  find_rest(const Model &model, Log &log)
  {
    RestState   rest(model);
    const Case &parameters = model.parameters;
    if (!parameters.static_state.stage_names().empty())
      rest.initial =
        find_static_state({model.discretization,
                           model.internal_force,
                           model.materials,
                           model.material_of_cell(),
                           parameters.boundaries,
                           model.mass,
                           model.terms,
                           rest.contact ? &*rest.contact : nullptr},
                          parameters.static_state,
                          parameters.load_list(),
                          log,
                          rest.summary);
    return rest;
  }


  namespace
  {
    ModalModel
    modal_model(const Model &model)
    {
      const Case &parameters = model.parameters;
      return {model.discretization,
              model.internal_force,
              parameters.material_names(),
              model.materials,
              model.material_of_cell(),
              parameters.boundaries,
              model.terms};
    }
  } // namespace


  void
  check_modes(const Model &model)
  {
    if (model.parameters.modes.number > 0)
      check_modes(modal_model(model), model.parameters.modes);
  }


  Modes
  find_modes(const Model &model, Log &log)
  {
    if (model.parameters.modes.number == 0)
      return {};
    return find_modes(modal_model(model), model.parameters.modes, log);
  }
} // namespace Voussoir
