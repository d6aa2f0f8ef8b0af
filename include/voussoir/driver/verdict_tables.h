#ifndef voussoir_driver_verdict_tables_h
#define voussoir_driver_verdict_tables_h

#include <voussoir/driver/run_setup.h>

namespace Voussoir
{
  /** Reduction of a strength by long cells up to which it counts as kept [%].
   */
  constexpr double most_lowered = 10.;

  /** The largest of a strength in tension or compression, in the run or in its
   *  static state [%]. Called on all ranks. */
  double
  lowered_strength(const Model &model);

  /**
   * Whether the computation can be trusted, as far as that is known before the
   * first step: time step, distortion of cells, strengths that cells too long
   * for their fracture energy lower, and the frequency that the cells of all
   * materials carry beside that of the earthquake. A table of lines as
   * at_most() makes them. Called on all ranks.
   */
  nlohmann::json
  numerical_checks(const RunSetup &setup);

  class Run;

  /** The same, and checks after the run: end, energy balance, contact, slips
   *  and cracks too wide for the model, missing files. Called on all ranks. */
  nlohmann::json
  numerical_checks(const Run &run);

  /**
   * Results of a run for the dam, from its summary, whether or not the case has
   * criteria of its own: demand over strength, whether a crack goes through or
   * a block is detached, slips and their rate at the end, safety of blocks. A
   * table of lines as at_most() makes them.
   */
  nlohmann::json
  engineering_results(const nlohmann::json &summary);

  /** A table in lines of text, under its name; empty if there is none. */
  std::string
  description(const std::string &title, const nlohmann::json &table);
} // namespace Voussoir

#endif
