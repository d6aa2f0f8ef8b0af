#ifndef voussoir_analysis_contact_equilibrium_h
#define voussoir_analysis_contact_equilibrium_h

#include <voussoir/analysis/elastic_solver.h>
#include <voussoir/base/log.h>

namespace Voussoir
{
  /**
   * Static equilibrium with interfaces by semi-smooth Newton steps on the
   * multigrid solver, under multipliers of contact that are updated in turn
   * (Alart and Curnier 1991). A step ends where the potential is least; the
   * shear limit of points that slide follows their pressure, but not in the
   * tangent, which so stays symmetric.
   */
  class ContactEquilibrium
  {
  public:
    /** What it took. */
    struct Effort
    {
      bool         found      = false;
      unsigned int iterations = 0;  // of the linear equations
      unsigned int steps      = 0;  // of Newton
      double       residual   = 0.; // over the loads

      StaticContact::Change last; // of the multipliers
    };

    /**
     * @param solver  with contact
     * @param springs of the absorbing boundary, or null if it is held
     */
    ContactEquilibrium(ElasticSolver       &solver,
                       const InternalForce &internal_force,
                       const NodalTerms    *springs,
                       Log                 &log);

    /**
     * @param displacement where to start from; the equilibrium if it was found,
     *   else as it was, and so is contact
     * @param memory    of materials that have cracked or yielded, whose
     *   equilibrium is found by initial stresses; null: they are elastic
     * @param tolerance of the forces of contact and ten times that of the
     *   equilibrium, over all of them
     */
    Effort
    find(Vector         &displacement,
         MaterialMemory *memory,
         const Vector   &force,
         const double    tolerance);

  private:
    /** The force less what bodies, springs and contact bear, on what is free;
     *  returns its norm. */
    double
    find_residual(const Vector   &displacement,
                  MaterialMemory *memory,
                  const Vector   &force);

    /** The share of a change at which the potential is least: further on it
     *  is the residual that works against the change. */
    double
    length_of_step(const Vector &displacement, const Vector &change) const;

    ElasticSolver       &solver;
    StaticContact       &contact;
    const InternalForce &internal_force;
    const NodalTerms    *springs;
    Log                 &log;
    Vector               residual;
  };
} // namespace Voussoir

#endif
