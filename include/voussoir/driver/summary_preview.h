#ifndef voussoir_driver_summary_preview_h
#define voussoir_driver_summary_preview_h

#include <voussoir/driver/run.h>

namespace Voussoir
{
  /**
   * Refuses paths of numbers that the summary of a run will not have: those of
   * criteria of the section "Acceptance", and quantities and criteria of a
   * study. The observers are evaluated once for a run that has not begun, and
   * write into a folder that is removed. Called on all ranks.
   */
  void
  check_summary_paths(Run &run);
} // namespace Voussoir

#endif
