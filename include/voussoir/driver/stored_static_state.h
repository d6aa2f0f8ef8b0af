#ifndef voussoir_driver_stored_static_state_h
#define voussoir_driver_stored_static_state_h

#include <voussoir/driver/static_state.h>

namespace Voussoir
{
  /**
   * Writes the static state into a file, so that it need not be computed again;
   * throws UserError if that fails.
   *
   * @param identity by which other runs find the state, see
   * static_identity_of(); none where only the run itself reads it
   */
  void
  store_static_state(const Model          &model,
                     const StaticState    &static_state,
                     const std::string    &file,
                     const nlohmann::json &identity = {});

  /** Reads the static state; throws UserError if the file is not whole or does
   *  not fit. */
  StaticState
  read_static_state(const Model &model, const std::string &file);

  /** The same for the natural modes. */
  void
  store_modes(const Model &model, const Modes &modes, const std::string &file);

  Modes
  read_modes(const Model &model, const std::string &file);
} // namespace Voussoir

#endif
