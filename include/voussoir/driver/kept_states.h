#ifndef voussoir_driver_kept_states_h
#define voussoir_driver_kept_states_h

#include <voussoir/driver/result_folder.h>
#include <voussoir/driver/static_state.h>

namespace Voussoir
{
  /**
   * The folder, shared by several runs, in which static states
   * are kept for later runs: of the same program, mesh, materials, interfaces,
   * boundaries, loads and stages, with any earthquake and on any number of
   * ranks.
   */
  class KeptStates
  {
  public:
    /** @param folder of this run, claimed */
    KeptStates(const Model &model, const ResultFolder &folder, Log &log);

    /** The kept state for this run; none if it is missing or damaged. */
    std::optional<StaticState>
    find() const;

    /** Keeps the state, unless another run is writing it; if that fails,
     *  the log has a warning. */
    void
    keep(const StaticState &static_state) const;

  private:
    const Model   &model;
    nlohmann::json identity;
    std::string    file; // empty: none is to be kept
    Log           &log;
  };
} // namespace Voussoir

#endif
