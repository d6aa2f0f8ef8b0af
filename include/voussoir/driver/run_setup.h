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
     * Throws UserError if there is no such time step.
     *
     * @param modes  to which damping is fitted, if the case asks for that;
     * before they are known there is no damping, which allows the longest step
     * @param folder whose checkpoint, if the run continues from one, has the
     * step
     */
    RunSetup(RunPlan           &&plan,
             const Modes        &modes,
             const ResultFolder &folder,
             Log                &log);

  private:
    /** Damping, and the cells that it is of. */
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
    RunPlan      plan; // whose motion the earthquake has
    const Model &model;

    const Damping damping;

    /** Internal force of the run: the moduli hold at the reference frequency of
     *  damping. */
    const InternalForce internal_force;

    const TimeStep                     time_step;
    Earthquake                         earthquake;
    const std::unique_ptr<WaterMotion> water; // compressible, or null
  };

  /** Refuses time steps of a case that are unstable under any damping, with the
   *  longest stable ones. */
  void
  check_without_damping(const RunPlan      &plan,
                        const ResultFolder &folder,
                        Log                &log);
} // namespace Voussoir

#endif
