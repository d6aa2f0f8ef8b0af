#ifndef voussoir_analysis_relaxation_h
#define voussoir_analysis_relaxation_h

#include <voussoir/base/log.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/time/central_difference.h>

namespace Voussoir
{
  /**
   * Equilibrium with contact by damped motion: the explicit steps of the run,
   * with the contact of the run, first undamped for a quarter of a period,
   * which measures the period, then with the critical damping of that period
   * until nothing moves any more. No stiffness is assembled, so joints may open
   * and slip as they like.
   */
  class Relaxation
  {
  public:
    /**
     * @param mass        of the run; what the static stage holds loses its own
     * @param terms       of the run
     * @param constraints hanging nodes and what the static stage holds
     * @param springs     whether the absorbing boundary stands on its springs
     */
    Relaxation(const Discretization                    &discretization,
               InternalForce                           &internal_force,
               const LumpedMass                        &mass,
               const NodalTerms                        &terms,
               const dealii::AffineConstraints<double> &constraints,
               const bool                               springs,
               Contact                                 *contact);

    /**
     * Moves the displacement to the equilibrium with a force. Throws UserError
     * if there is none within 50 000 steps.
     *
     * @param tolerance largest motion in a period over the largest displacement
     * @return the number of steps
     */
    unsigned int
    find_equilibrium(Vector       &displacement,
                     const Vector &force,
                     const double  tolerance,
                     Log          &log);

  private:
    CentralDifference
    make_scheme(const double mass_coefficient);

    /** Undamped until the kinetic energy stops growing; returns that time. */
    double
    quarter_period(State &state, unsigned int &steps);

    const Discretization &discretization;
    InternalForce        &internal_force;
    LumpedMass            mass;
    NodalTerms            terms;
    Contact              *contact; // or null
    double                time_step;
    InitialState          loaded;
  };
} // namespace Voussoir

#endif
