#ifndef voussoir_output_energy_h
#define voussoir_output_energy_h

#include <voussoir/output/table.h>
#include <voussoir/time/central_difference.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /**
   * Where the energy is and where it went, all in J and half a step before the
   * time of the state. With kinetic energy v^T M v / 2 of the half step and
   * strain energy u_n^T K u_(n-1) / 2 the balance of the undamped scheme is
   * exact, not only to the order of the time step: the work on the cells is
   * summed in every step, and what they have not stored nor lost otherwise is
   * lost in damping. It must not fall: what does not obey its law makes energy
   * there. After a static stage u is the displacement since then: what the
   * static loads do is left out on both sides.
   */
  struct EnergyTerms
  {
    double kinetic     = 0.;
    double strain      = 0.; // cells and boundary springs
    double memory      = 0.; // in the springs of the Maxwell branches
    double damping     = 0.; // lost in the material so far
    double boundary    = 0.; // gone through the boundary dashpots so far
    double material    = 0.; // lost to cracks and plastic flow so far
    double closing     = 0.; // lost by cracks that closed so far
    double input       = 0.; // work of all forces and of a moving base so far
    double constraints = 0.; // work of the projections so far

    double
    stored() const
    {
      return kinetic + strain + memory;
    }

    /** What is unaccounted for. */
    double
    error(const double initial) const
    {
      return input + constraints + initial - stored() - damping - material -
             closing - boundary;
    }
  };

  /**
   * The energy balance: evaluated at intervals, written to energy.csv, and the
   * alarm when something goes wrong.
   */
  class EnergyBalance
  {
  public:
    /** @param equation of the motion; must live as long as this */
    EnergyBalance(const EquationOfMotion &equation, const double time_step);

    /** Writes to energy.csv in this folder from now on. @p restarted: continue
     *  the file of a run that was interrupted at @p start_time [s]. */
    void
    open(const std::string &folder,
         const double       start_time,
         const bool         restarted,
         Log               &log);

    /** Evaluates the balance at the state. */
    const EnergyTerms &
    evaluate(const State &state);

    const EnergyTerms &
    latest() const;

    /** Energy from nowhere [J]: what no account explains, what damping has
     * given back, and what cracks made when they closed. */
    double
    made() const;

    /** That over the largest energy that came in and did not go out through the
     *  boundary at once, so far. */
    double
    relative_error() const;

    /** That over what damping, cracks, friction and impacts took; zero as long
     *  as they took next to nothing. */
    double
    error_of_losses() const;

    /** Why the run must stop: not finite, growing without bound, or more energy
     *  from nowhere than this share of what came in; else an empty text. */
    std::string
    alarm(const double limit) const;

    nlohmann::json
    summary() const;

    /** Accumulated numbers for a checkpoint. */
    nlohmann::json
    save() const;

    void
    load(const nlohmann::json &saved);

  private:
    /** Energy in the Maxwell branches at points that are elastic [J]. */
    double
    energy_of_branches(const State &state);

    const EquationOfMotion equation;
    const double           time_step;

    EnergyTerms terms_now;
    double      initial = 0., came_in = 0., largest_error = 0.;
    double      initial_in_cells = 0., most_damping = 0.; // [J]
    double      static_work = 0.; // of the loads of the static state [J]
    bool        first       = true;
    Vector      moved, moved_before; // at the step and the one before
    Vector      force_at_rest;       // on the cells beside F_0; empty: none
    TimeTable   table;
  };
} // namespace Voussoir

#endif
