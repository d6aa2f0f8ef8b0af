#ifndef voussoir_driver_case_identity_h
#define voussoir_driver_case_identity_h

#include <voussoir/driver/case.h>

#include <nlohmann/json.hpp>

#include <optional>
#include <utility>

namespace Voussoir
{
  /**
   * Data that must not change between a checkpoint and the run that continues
   * from it: all entries except those for the duration and the times of output,
   * as "Section/Entry = value", and the checksums of the files that entries
   * name.
   */
  nlohmann::json
  identity_of(const Case &parameters);

  /** Data that must be the same for a static state to be valid for a case: the
   *  program and those entries and files that it depends on. */
  nlohmann::json
  static_identity_of(const Case &parameters);

  /** Data that the results of a run depend on: identity_of() with the duration
   *  and the times of output. */
  nlohmann::json
  result_identity_of(const Case &parameters);

  /** The first entry in which two identities differ, with its value in each
   *  ("nothing" where it is missing). Files are compared by their contents, as
   *  they may have been moved. */
  std::optional<std::pair<std::string, std::string>>
  first_difference(const nlohmann::json &one, const nlohmann::json &other);

  /** FNV-1a, in hexadecimal digits. */
  std::string
  checksum(const std::string &bytes);

  /** Refuses another identity; @p checkpoint names its file. */
  void
  check_identity(const Case           &parameters,
                 const nlohmann::json &identity,
                 const std::string    &checkpoint);
} // namespace Voussoir

#endif
