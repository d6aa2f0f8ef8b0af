#ifndef voussoir_fem_stable_step_h
#define voussoir_fem_stable_step_h

#include <voussoir/fem/internal_force.h>
#include <voussoir/fem/lumped_mass.h>

#include <ostream>

namespace Voussoir
{
  /**
   * Contributions to the limit of the time step beside the mass and the
   * stiffness of the cells: the scheme is stable up to the dt at which the
   * largest eigenvalue of M^-1 [ sum_m (1 + s_m gamma(dt) + 2 beta/dt) K_m +
   * diagonal terms ] reaches 4/dt^2, with the damping factor s_m of each
   * material and the mesh viscosity beta.
   */
  struct StepLimits
  {
    /** gamma(dt): sum of the Maxwell coefficients, or 2 beta/dt (Rayleigh);
     *  null: zero. */
    std::function<double(const double dt)> stiffening;

    /** Adds the diagonal terms (boundary springs; dashpots and mass damping
     *  times 2/dt where they are not treated centrally); null: none. */
    std::function<
      void(Vector &force, const Vector &displacement, const double dt)>
      add_diagonal;

    /** Damping::mesh_viscosity [s]. */
    double mesh_viscosity = 0.;

    /** A step near the limit, which spares iterations [s]; 0: not known. */
    double guess = 0.;

    bool
    depend_on_step() const
    {
      return stiffening || add_diagonal || mesh_viscosity > 0.;
    }
  };

  /**
   * The largest stable time step [s], from Lanczos iterations on the operator
   * of the run (not from element bounds, which lose 18 to 36 %).
   */
  double
  stable_step(const Discretization &discretization,
              const InternalForce  &force,
              const LumpedMass     &mass,
              const StepLimits     &limits);

  /** The undamped limit of each cell by itself, and the governing cell. */
  class ElementSteps
  {
  public:
    ElementSteps(const Discretization      &discretization,
                 const InternalForce       &force,
                 const std::vector<double> &density);

    /** Prints the histogram and the governing cell, on the first rank. */
    void
    print(std::ostream &out) const;

    /** Smallest limit [s], where it is, and the sets it belongs to. */
    double           smallest;
    dealii::Point<3> place;
    std::string      sets;

  private:
    std::vector<unsigned long long> histogram;
  };
} // namespace Voussoir

#endif
