#ifndef voussoir_analysis_relaxation_h
#define voussoir_analysis_relaxation_h

#include <voussoir/analysis/static_cracks.h>
#include <voussoir/base/log.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/time/central_difference.h>

namespace Voussoir
{
  /**
   * Equilibrium with contact by dynamic relaxation: the explicit steps of the
   * run, with the contact of the run and, until the motion has ceased, with
   * the critical damping of the frequency that Rayleigh's quotient of the
   * velocity gives. It is high as long as many modes move, then that of the
   * slowest mode (adaptive, Underwood 1983). No stiffness is assembled, so
   * joints may open and slip without limit.
   */
  class Relaxation
  {
  public:
    /**
     * @param internal_force of the static stage, as are the cracks in cells
     * @param mass        of the run; nodes that the static stage fixes get none
     * @param terms       of the run
     * @param constraints of hanging nodes and nodes that the static stage fixes
     * @param springs whether springs support the absorbing boundary
     */
    Relaxation(const Discretization                    &discretization,
               const InternalForce                     &internal_force,
               StaticCracks                            &cracks,
               const LumpedMass                        &mass,
               const NodalTerms                        &terms,
               const dealii::AffineConstraints<double> &constraints,
               const bool                               springs,
               Contact                                 *contact);

    /** How a relaxation ended. */
    struct Result
    {
      bool         at_rest = false;
      unsigned int steps   = 0;
    };

    /**
     * Moves the displacement to the equilibrium with a force, or until the
     * search is given up: after 50 000 steps, or where displacements are no
     * longer small: above a hundredth of the size of the model or, at contact
     * points, above a side of a cell.
     *
     * @param memory    internal variables of the materials, which follow the
     * motion; empty: they are elastic
     * @param tolerance largest motion in a period over the largest displacement
     */
    Result
    find_equilibrium(Vector         &displacement,
                     MaterialMemory &memory,
                     const Vector   &force,
                     const double    tolerance,
                     Log            &log);

  private:
    /** The explicit steps under this mass-proportional damping [1/s]. */
    std::unique_ptr<CentralDifference>
    make_scheme(const double mass_coefficient);

    /** Whether displacements are too large for the theory of small
     *  displacements. */
    bool
    too_far(const Vector &displacement) const;

    /**
     * Root of v K v / (v M v) [rad/s], where K v follows from the time
     * derivative of the equation of motion, M a' + c M a + K v = 0.
     *
     * @param velocity of the last three steps
     */
    double
    natural_frequency(const std::array<Vector, 3> &velocity,
                      const double                 mass_coefficient) const;

    const Discretization &discretization;
    const InternalForce  &internal_force;
    StaticCracks         &cracks;
    LumpedMass            mass;
    NodalTerms            terms;
    Damping               damping;
    Contact              *contact; // or null
    const double          extent;  // of the model [m]
    double                time_step;
    InitialState          loaded;
  };
} // namespace Voussoir

#endif
