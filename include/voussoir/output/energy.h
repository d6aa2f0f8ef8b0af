#ifndef voussoir_output_energy_h
#define voussoir_output_energy_h

#include <voussoir/files/table.h>
#include <voussoir/output/observer.h>
#include <voussoir/time/central_difference.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /**
   * Stored energies, losses and work, all in J and half a step before the time
   * of the state. With kinetic energy v^T M v / 2 of the half step and strain
   * energy u_n^T K u_(n-1) / 2 the balance of the undamped scheme is exact, not
   * only to the order of the time step. Every loss is a sum of its own, none is
   * the remainder of the others: their residual is the energy-balance error.
   * After a static stage u is the displacement since then: the work of the
   * static loads is left out on both sides.
   */
  struct EnergyTerms
  {
    double kinetic     = 0.;
    double strain      = 0.; // cells and boundary springs
    double memory      = 0.; // in the springs of the Maxwell branches
    double damping     = 0.; // lost in the material so far
    double boundary    = 0.; // radiated through the boundary dashpots so far
    double material    = 0.; // lost to cracks and plastic flow so far
    double closing     = 0.; // lost by cracks that closed so far
    double input       = 0.; // work of all forces and of a moving base so far
    double constraints = 0.; // work of the projections so far

    double
    stored() const
    {
      return kinetic + strain + memory;
    }

    double
    lost() const
    {
      return damping + boundary + material + closing;
    }

    /** Energy-balance error [J]. */
    double
    error(const double initial) const
    {
      return input + constraints + initial - stored() - lost();
    }
  };

  /** Results of the balance so far. */
  struct EnergySummary
  {
    EnergyTerms terms;
    double      initial = 0., error = 0.; // [J]

    /** Energy-balance errors: see relative_error(), the largest of them, and
     *  error_of_losses() of the balance [1]. */
    double error_of_input = 0., largest_error = 0., error_of_losses = 0.;
  };

  void
  to_json(nlohmann::json &json, const EnergySummary &summary);

  void
  from_json(const nlohmann::json &json, EnergySummary &summary);

  /**
   * The energy balance: evaluated at intervals, written to energy.csv, and the
   * reason to stop where it is violated.
   *
   * The losses of Maxwell branches and of viscosity in elastic cells are known
   * exactly for one step, at the cost of some products with the stiffness, and
   * are summed over the steps between two evaluations by the trapezoidal rule,
   * which is exact if the balance is evaluated after every step.
   */
  class EnergyBalance
  {
  public:
    /**
     * @param equation  of the motion; must live as long as this
     * @param time_step [s]
     * @param interval  between two lines of energy.csv [s]; 0: 50 steps
     */
    EnergyBalance(const EquationOfMotion &equation,
                  const double            time_step,
                  const double            interval);

    /** Writes to energy.csv in this folder from now on. @p restarted: continue
     *  the file of a run that was interrupted at @p start_time [s]. */
    void
    open(const std::string &folder,
         const double       start_time,
         const bool         restarted,
         Log               &log);

    /** Whether the balance is to be evaluated after a step: at its lines, and
     *  often enough for the sums of the losses by damping. */
    bool
    is_due(const unsigned long long step) const;

    /** Stores the velocity before a step after which the balance is due. */
    void
    before_step(const State &state);

    /** Evaluates the balance at the state, and writes its line if it is time
     *  or this is the @p end of the run. The points of the state store the
     *  imbalance of their branches. */
    const EnergyTerms &
    evaluate(State &state, const bool end = false);

    const EnergyTerms &
    latest() const;

    /** Energy-balance error [J]: the residual of all sums, negative losses of
     *  damping, and energy that cracks gained when they closed. */
    double
    made() const;

    /** The error over the largest energy input so far that did not leave
     *  through the boundary at once. */
    double
    relative_error() const;

    /** The error over the losses by damping, cracks, friction and impacts; zero
     *  as long as these are nearly zero. */
    double
    error_of_losses() const;

    /** Reason why the run must stop: motion that is not finite or grows without
     *  bound, or an error above this share of the energy input; else an
     *  empty text. */
    std::string
    alarm(const double limit) const;

    EnergySummary
    summary() const;

    /** Accumulated sums for a checkpoint. */
    nlohmann::json
    save() const;

    void
    load(const nlohmann::json &saved);

  private:
    /** Sums up the terms at the state. */
    void
    sum_up(State &state);

    /** Least energy to which the error is to be compared [J]. */
    double
    least_scale(const unsigned long long step) const;

    /** Sum of the losses of the elastic cells up to this step, from those in
     * the next and in the last step [J]. */
    double
    loss_in_cells(const unsigned long long step,
                  const double             next_loss,
                  const double             last_loss);

    const EquationOfMotion equation;
    const double           time_step;
    const bool             viscous;
    const unsigned int     most_steps; // from one evaluation to the next
    const Schedule         lines;

    EnergyTerms terms_now;
    double      initial = 0., came_in = 0., largest_error = 0.;
    double      most_damping = 0.; // [J]
    double      static_work  = 0.; // of the loads of the static state [J]
    bool        first        = true;
    Vector      moved;
    Vector      velocity_before; // v- of the step after `kept_step`
    TimeTable   table;

    // loss of the elastic cells up to the last evaluation, and in the steps
    // after and before it; see ElasticEnergy [J]
    double             known_loss = 0., next_loss = 0., last_loss = 0.;
    unsigned int       steps_between = 1; // to the next one
    unsigned long long loss_step = 0, due_step = 0, kept_step = 0;
  };
} // namespace Voussoir

#endif
