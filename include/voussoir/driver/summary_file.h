#ifndef voussoir_driver_summary_file_h
#define voussoir_driver_summary_file_h

#include <voussoir/base/log.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /** Writes summary.json into a folder: what is given, the verdict, the
   *  warnings and the files that could not be written. Called on all ranks. */
  void
  write_summary(const std::string &folder,
                nlohmann::json     summary,
                const std::string &verdict,
                Log               &log);
} // namespace Voussoir

#endif
