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


  Modes
  find_modes(const Model &model, Log &log)
  {
    const Case &parameters = model.parameters;
    if (parameters.modes.number == 0)
      return {};
    return find_modes({model.discretization,
                       model.internal_force,
                       parameters.material_names(),
                       model.materials,
                       model.material_of_cell(),
                       parameters.boundaries,
                       model.terms},
                      parameters.modes,
                      log);
  }
} // namespace Voussoir
