#ifndef voussoir_driver_run_setup_h
#define voussoir_driver_run_setup_h

#include <voussoir/driver/result_folder.h>
#include <voussoir/driver/run_plan.h>
#include <voussoir/loads/water_motion.h>

namespace Voussoir
{
  /**
   * The parts of a run besides the static state: its plan, its damping, and the
   * moduli and the time step, which depend on damping.
   */
  class RunSetup
  {
  public:
    /**
     * Throws UserError if the time step of the case is unstable.
     *
     * @param modes to which damping is fitted, if the case asks for that; until
     *   they are known the setup has no damping and so the longest step
     * @param folder of the checkpoint, if the run continues from one, whose
     *   time step is kept
     */
    RunSetup(RunPlan           &&plan,
             const Modes        &modes,
             const ResultFolder &folder,
             Log                &log);

  private:
    /** Damping, and the cells to which it applies. */
    struct DampedCells
    {
      DampedCells(const Model &model, const Modes &modes);

      Damping       damping;
      InternalForce internal_force;
      double        undamped_limit;
    };

    RunSetup(RunPlan           &&plan,
             DampedCells       &&cells,
             const ResultFolder &folder,
             Log                &log);

  public:
    RunPlan      plan; // its motion has been moved into the earthquake
    const Model &model;

    const Damping damping;

    /** Internal force of the run: the moduli hold at the reference frequency of
     *  damping. */
    const InternalForce internal_force;

    const TimeStep                     time_step;
    Earthquake                         earthquake;
    const std::unique_ptr<WaterMotion> water; // compressible, or null
  };

  /** Refuses a time step of the case that is unstable even without damping; the
   *  message has the largest stable one. */
  void
  check_without_damping(const RunPlan      &plan,
                        const ResultFolder &folder,
                        Log                &log);
} // namespace Voussoir

#endif
