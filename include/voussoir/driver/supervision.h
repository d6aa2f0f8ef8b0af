#ifndef voussoir_driver_supervision_h
#define voussoir_driver_supervision_h

#include <voussoir/output/energy.h>

namespace Voussoir
{
  /** Supervises a run: warns once of each limitation of its results, and
   *  reports why it must stop. */
  class Supervision
  {
  public:
    /**
     * @param run,energy   must live as long as this
     * @param energy_limit of the energy-balance error, see EnergyBalance::alarm
     * @param lowered_strength by long cells [%]
     */
    Supervision(const ObservedRun   &run,
                const EnergyBalance &energy,
                const double         energy_limit,
                const double         lowered_strength);

    /** Evaluates the energy balance of a state. If the run must stop the result
     *  is the reason, else it is empty, and the state is the last good one. */
    std::string
    check_energy(const State &state);

    /** Stores the data for a picture of the last good state. */
    void
    keep(const State &state);

    /** Checks cracks and slips at intervals and at the end. */
    void
    check_motion(const State &state, const bool at_end);

    /** Warns of unsolved contact. */
    void
    check_contact() const;

    /** Writes a picture of the last good state into the folder of the run.
     *  @return name of the file there; empty if it cannot be written */
    std::string
    draw_last_good() const;

  private:
    /** Warns of cracks so wide that they detach a block. */
    void
    check_cracks(const double time);

    /** Warns of slips so large that nodes no longer lie opposite their
     *  partners. */
    void
    check_slips(const double time);

    const ObservedRun   &run;
    const EnergyBalance &energy;
    const double         energy_limit, lowered_strength;
    const bool           has_memory;
    const Schedule       checks; // of cracks and slips

    /** Data of a picture, in single precision. */
    struct Motion
    {
      using Values = std::vector<float>; // of the owned unknowns

      Values              displacement, velocity;
      std::vector<Values> memory; // of elastic materials, for the stress
      double              time = 0.;
    };

    Motion last_good;
    bool   warned_of_energy = false, warned_of_cracks = false,
         warned_of_slips = false;
  };
} // namespace Voussoir

#endif
