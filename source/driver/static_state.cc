#include <voussoir/driver/static_state.h>
#include <voussoir/fem/crack_tips.h>
#include <voussoir/fem/notches.h>

namespace Voussoir
{
  namespace
  {
    std::vector<const CellKernel *>
    kernels_at_rest(const Model &model)
    {
      return for_each_material(
        model.solid.materials,
        [](const Material &material) -> const CellKernel * {
          return &material.at_rest();
        });
    }
  } // namespace


  StaticState::StaticState(const Model &model)
  {
    initial.material_memory = model.solid.internal_force.new_memory();
    weaken_at_notches(model.solid.discretization,
                      kernels_at_rest(model),
                      initial.material_memory);
    if (model.contact)
      contact.emplace(*model.contact);
  }


  StaticState
  find_static_state(const Model &model, Log &log)
  {
    StaticState static_state(model);
    const Case &parameters = model.parameters;
    const auto  n_before   = log.warnings().size();
    if (!parameters.static_state.stage_names().empty())
      static_state.initial =
        find_static_state({model.solid,
                           parameters.boundaries,
                           model.terms,
                           static_state.contact ? &*static_state.contact :
                                                  nullptr},
                          parameters.static_state,
                          model.load_list(),
                          log,
                          static_state.summary);
    // these warnings apply to all runs from this static state
    if (const auto &all = log.warnings(); all.size() > n_before)
      static_state.summary["warnings"] =
        std::vector<std::string>(all.begin() + n_before, all.end());
    return static_state;
  }


  StaticState
  handed_over(StaticState        &&found,
              const Model         &model,
              const InternalForce &internal_force,
              Log                 &log)
  {
    StaticState static_state(std::move(found));
    CrackTips(model.solid.discretization,
              {model.solid.materials.begin(), model.solid.materials.end()})
      .take_over(kernels_at_rest(model), static_state.initial.material_memory);
    const double dissipated = dealii::Utilities::MPI::sum(
      hand_over(static_state.initial, internal_force, model.terms),
      log.communicator());
    double of_stages = 0.;
    if (static_state.summary.contains("stages"))
      of_stages =
        static_state.summary["stages"].back().at("dissipated by materials [J]");
    if (dissipated > 0.01 * std::max(of_stages, 1.))
      log.warn("as the earthquake begins, materials dissipate ",
               dissipated,
               " J at once, beside ",
               of_stages,
               " J in the static state: the static stress exceeds their "
               "strength");
    return static_state;
  }


  namespace
  {
    /** The interfaces with their gaps in the static state, or null. */
    std::optional<Contact>
    contact_at(const StaticState &static_state, const Model &model)
    {
      if (!static_state.contact ||
          static_state.initial.displacement.size() == 0)
        return static_state.contact;
      std::optional<Contact> contact(static_state.contact);
      State                  state;
      state.displacement = static_state.initial.displacement;
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
  find_modes(const Model &model, const StaticState &static_state, Log &log)
  {
    if (model.parameters.modes.number == 0)
      return {};
    const std::optional<Contact> contact = contact_at(static_state, model);
    return find_modes(modal_model(model, contact ? &*contact : nullptr),
                      model.parameters.modes,
                      log);
  }
} // namespace Voussoir
