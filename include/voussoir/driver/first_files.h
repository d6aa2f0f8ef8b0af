#ifndef voussoir_driver_first_files_h
#define voussoir_driver_first_files_h

#include <voussoir/driver/earthquake.h>
#include <voussoir/output/observer.h>

namespace Voussoir
{
  /** Writes ground_motion.csv and, of a matched motion,
   * ground_motion_spectra.csv into a folder. */
  void
  write_ground_motion(const EarthquakeMotion &motion,
                      const std::string      &folder,
                      Log                    &log);

  /** Writes static_stages.csv, a line for each stage of the summary of a static
   *  state, into a folder. */
  void
  write_static_stages(const nlohmann::json &static_state,
                      const std::string    &folder,
                      Log                  &log);

  /** Writes modes.vtu into the folder of a run, if there are modes. */
  void
  write_modes(const Modes &modes, const ObservedRun &run);
} // namespace Voussoir

#endif
