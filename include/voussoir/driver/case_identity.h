#ifndef voussoir_driver_case_identity_h
#define voussoir_driver_case_identity_h

#include <voussoir/driver/case.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /**
   * What must not change between a checkpoint and the run that goes on from it:
   * each entry but those that only say how long to run and what to write when,
   * as "Section/Entry = value", and the checksums of the files that entries
   * name.
   */
  nlohmann::json
  identity_of(const Case &parameters);

  /** Refuses another identity; @p checkpoint names the file it is from. */
  void
  check_identity(const Case           &parameters,
                 const nlohmann::json &identity,
                 const std::string    &checkpoint);
} // namespace Voussoir

#endif
