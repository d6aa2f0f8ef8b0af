#ifndef voussoir_driver_verdict_tables_h
#define voussoir_driver_verdict_tables_h

#include <voussoir/driver/run_setup.h>

namespace Voussoir
{
  /** Reduction of a strength by long cells up to which it counts as kept [%].
   */
  constexpr double most_lowered = 10.;

  /** Opening of a crack over its cell beyond which it detaches a block. */
  constexpr double widest_crack_share = 0.02;

  /** The largest of a strength in tension or compression, in the run or in its
   *  static state [%]. Called on all ranks. */
  double
  lowered_strength(const Model &model);

  /**
   * Numerical checks that are possible before the first step: time step,
   * distortion of cells, strengths lowered by cells that are too long for their
   * fracture energy, and the frequency that the cells of all materials carry
   * against that of the earthquake. A table of lines as at_most() makes them.
   * Called on all ranks.
   */
  nlohmann::json
  numerical_checks(const RunSetup &setup);

  class Run;

  /** The same, and checks after the run: end, energy balance, contact, slips
   *  and cracks too wide for the model, missing files. Called on all ranks. */
  nlohmann::json
  numerical_checks(const Run &run);

  /**
   * Engineering results of a run, from its summary, with or without criteria of
   * the case: demand over strength, whether a crack goes through or a block is
   * detached, slips and their rate at the end, safety of blocks. A table of
   * lines as at_most() makes them.
   */
  nlohmann::json
  engineering_results(const nlohmann::json &summary);

  /** A table in lines of text, under its name; empty if there is none. */
  std::string
  description(const std::string &title, const nlohmann::json &table);
} // namespace Voussoir

#endif
