#ifndef voussoir_driver_run_plan_h
#define voussoir_driver_run_plan_h

#include <voussoir/driver/earthquake.h>
#include <voussoir/output/observer.h>

namespace Voussoir
{
  /**
   * The parts of a run that do not depend on its damping, which may be fitted
   * to the natural modes and so depend on the static state. Mistakes in these
   * parts are refused here, before static state and modes are computed.
   */
  class RunPlan
  {
  public:
    /** Throws UserError for a run that cannot be computed or recorded.
     *
     *  @param model must live as long as this */
    RunPlan(const Model &model, Log &log);

    /** Access of observers to the model. */
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
