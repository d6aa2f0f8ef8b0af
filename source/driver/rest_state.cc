#include <voussoir/driver/rest_state.h>

namespace Voussoir
{
  RestState::RestState(const Model &model)
  {
    initial.material_memory = model.solid.internal_force.new_memory();
    if (model.contact)
      contact.emplace(*model.contact);
  }


  RestState
  find_rest(const Model &model, Log &log)
  {
    RestState   rest(model);
    const Case &parameters = model.parameters;
    const auto  n_before   = log.warnings().size();
    if (!parameters.static_state.stage_names().empty())
      rest.initial =
        find_static_state({model.solid,
                           parameters.boundaries,
                           model.terms,
                           rest.contact ? &*rest.contact : nullptr},
                          parameters.static_state,
                          model.load_list(),
                          log,
                          rest.summary);
    // they hold for all runs that begin with it
    if (const auto &all = log.warnings(); all.size() > n_before)
      rest.summary["warnings"] =
        std::vector<std::string>(all.begin() + n_before, all.end());
    return rest;
  }


  RestState
  handed_over(RestState          &&found,
              const Model         &model,
              const InternalForce &internal_force,
              Log                 &log)
  {
    RestState    rest(std::move(found));
    const double dissipated = dealii::Utilities::MPI::sum(
      hand_over(rest.initial, internal_force, model.terms), log.communicator());
    double at_rest = 0.;
    if (rest.summary.contains("stages"))
      at_rest = rest.summary["stages"].back().at("dissipated by materials [J]");
    if (dissipated > 0.01 * std::max(at_rest, 1.))
      log.warn("as the earthquake begins, materials dissipate ",
               dissipated,
               " J at once, beside ",
               at_rest,
               " J in the static state: their laws do not bear its stress");
    return rest;
  }


  namespace
  {
    /** The interfaces with their gaps at rest, or nothing. */
    std::optional<Contact>
    contact_at(const RestState &rest, const Model &model)
    {
      if (!rest.contact || rest.initial.displacement.size() == 0)
        return rest.contact;
      std::optional<Contact> contact(rest.contact);
      State                  state;
      state.displacement = rest.initial.displacement;
      state.velocity     = model.solid.discretization.create_vector();
      contact->start(state);
      return contact;
    }


    ModalModel
    modal_model(const Model &model, const Contact *contact)
    {
      const Case &parameters = model.parameters;
      return {model.solid,
              parameters.material_names(),
              parameters.boundaries,
              model.terms,
              contact,
              model.reservoir_of_modes.get()};
    }
  } // namespace


  void
  check_modes(const Model &model)
  {
    if (model.parameters.modes.number > 0)
      check_modes(modal_model(model, model.contact.get()),
                  model.parameters.modes);
  }


  Modes
  find_modes(const Model &model, const RestState &rest, Log &log)
  {
    if (model.parameters.modes.number == 0)
      return {};
    const std::optional<Contact> contact = contact_at(rest, model);
    return find_modes(modal_model(model, contact ? &*contact : nullptr),
                      model.parameters.modes,
                      log);
  }
} // namespace Voussoir
