#ifndef voussoir_driver_stored_rest_h
#define voussoir_driver_stored_rest_h

#include <voussoir/driver/rest_state.h>

namespace Voussoir
{
  /**
   * Writes the state at rest into a file, so that it need not be found again;
   * throws UserError if that fails.
   *
   * @param identity by which others know it, see static_identity_of(); none
   *   where the run itself reads it
   */
  void
  store_rest(const Model          &model,
             const RestState      &rest,
             const std::string    &file,
             const nlohmann::json &identity = {});

  /** Reads it; throws UserError if the file is not whole or does not fit. */
  RestState
  read_rest(const Model &model, const std::string &file);

  /** The same for the natural modes. */
  void
  store_modes(const Model &model, const Modes &modes, const std::string &file);

  Modes
  read_modes(const Model &model, const std::string &file);
} // namespace Voussoir

#endif
