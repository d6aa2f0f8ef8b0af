#ifndef voussoir_driver_static_state_h
#define voussoir_driver_static_state_h

#include <voussoir/driver/model.h>

namespace Voussoir
{
  /** The model in equilibrium under the loads of the static stages, before the
   *  earthquake. */
  struct StaticState
  {
    /** The state of a model without static stages. */
    explicit StaticState(const Model &model);

    InitialState initial;

    /** The interfaces after the static stages; none without. */
    std::optional<Contact> contact;

    /** Resultants, reactions and iterations by stage; null without. */
    nlohmann::json summary;
  };

  /** Applies the static stages of the case, if it has any. */
  StaticState
  find_static_state(const Model &model, Log &log);

  /** The same state with the moduli of the run that has this internal force;
   *  see hand_over of the static state. */
  StaticState
  handed_over(StaticState        &&found,
              const Model         &model,
              const InternalForce &internal_force,
              Log                 &log);

  /** Refuses more natural modes than the model has. */
  void
  check_modes(const Model &model);

  /** The natural modes that the case asks for, about the static state. */
  Modes
  find_modes(const Model &model, const StaticState &static_state, Log &log);
} // namespace Voussoir

#endif
