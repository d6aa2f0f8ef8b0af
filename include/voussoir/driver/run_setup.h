#ifndef voussoir_driver_run_setup_h
#define voussoir_driver_run_setup_h

#include <voussoir/driver/earthquake.h>
#include <voussoir/driver/result_folder.h>
#include <voussoir/loads/water_motion.h>
#include <voussoir/output/observer.h>

namespace Voussoir
{
  /**
   * What a run is made of that does not depend on the static state. Whatever a
   * run may refuse is refused here, before that is computed.
   */
  class RunSetup
  {
  public:
    /**
     * Throws UserError for what cannot be computed or recorded.
     *
     * @param model  must live as long as this
     * @param modes  to which damping is adapted, if the case wants that; before
     *   they are known there is none, which allows for the longest step
     * @param folder whose checkpoint, if the run goes on from one, has the step
     */
    RunSetup(const Model        &model,
             const Modes        &modes,
             const ResultFolder &folder,
             Log                &log);

    /** What observers see of a run, whose parts are given by the caller. */
    ObservedModel
    observed(const std::string       &folder,
             const InitialState      &initial,
             const MaterialMemory    &memory,
             const Contact           *contact,
             Log                     &log,
             const CentralDifference *scheme = nullptr) const;

    /** What summary.json says of the model, whatever becomes of the run. Called
     *  on all ranks. */
    nlohmann::json
    summary(const MPI_Comm communicator) const;

    const Model &model;

    /** Constraints and observers of the case by name, in their order. */
    const NamedObjects<Projection>::List constraints;
    const NamedObjects<Observer>::List   observers;

    /** Of the run: the moduli hold at the reference frequency of damping. */
    const InternalForce internal_force;

    const double  undamped_limit; // [s], 0 where damping does not change it
    const Damping damping;

    const TimeStep                     time_step;
    Earthquake                         earthquake;
    const std::unique_ptr<WaterMotion> water; // compressible, or null
  };
} // namespace Voussoir

#endif
