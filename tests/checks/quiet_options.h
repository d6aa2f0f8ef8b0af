#ifndef voussoir_tests_quiet_options_h
#define voussoir_tests_quiet_options_h

#include <voussoir/driver/result_folder.h>

namespace Voussoir
{
  /** Options of a run without a log on the terminal. */
  inline RunOptions
  quiet_options(const bool restart)
  {
    RunOptions result;
    result.restart = restart;
    result.quiet   = true;
    return result;
  }
} // namespace Voussoir

#endif
