#ifndef voussoir_driver_run_plan_h
#define voussoir_driver_run_plan_h

#include <voussoir/driver/earthquake.h>
#include <voussoir/output/observer.h>

namespace Voussoir
{
  /**
   * What a run is to have that does not depend on its damping, which may go by
   * the natural modes and so by the static state. What can be refused of it is
   * refused here, before these are computed.
   */
  class RunPlan
  {
  public:
    /** Throws UserError for what cannot be computed or recorded.
     *
     * @param model must live as long as this */
    RunPlan(const Model &model, Log &log);

    /** What observers see of the model. */
    ObservedModel
    observed(Log &log) const;

    /** The shortest of all records [s]; 0 if nothing is recorded. */
    double
    record_interval() const;

    const Model &model;

    /** Constraints and observers of the case by name, in their order. */
    NamedObjects<Projection>::List constraints;
    NamedObjects<Observer>::List   observers;

    EarthquakeMotion motion;
  };
} // namespace Voussoir

#endif
