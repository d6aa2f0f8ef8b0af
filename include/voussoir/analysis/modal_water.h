#ifndef voussoir_analysis_modal_water_h
#define voussoir_analysis_modal_water_h

#include <voussoir/analysis/pressure_solver.h>
#include <voussoir/loads/reservoir.h>

namespace Voussoir
{
  /**
   * Cells of water that take part in the natural modes. With the pressure
   * Laplacian H, the storage Q of a pressure, volume/(rho c^2), and the flux
   * S^T u that the wall's displacement u causes, the pressure of a motion at
   * omega is (1/rho H - omega^2 Q) p = omega^2 S^T u .
   *
   * Incompressible water, Q = 0, is an added mass, M_a = rho S H^-1 S^T. With
   * H^-1, the equations of solid and compressible water are symmetric, too:
   *   | K 0 | |u|           /| M 0 |       |S|                \ |u|
   *   | 0 Q | |p| = omega^2 ( | 0 0 | + rho |Q| H^-1 (S^T  Q)  ) |p| ,
   * with the water's compression as a stiffness. Both sides are positive. The
   * unknown in place of p is sqrt(Q/k) p, a displacement, with a uniform
   * stiffness k.
   *
   * Far end and bottom reflect; the surface has no pressure.
   */
  class ModalWater
  {
  public:
    /** @param stiffness k of compressible water [N/m]; 0: incompressible */
    ModalWater(const Reservoir &reservoir, const double stiffness);

    /** Owned unknowns of the compressible water, surface included. */
    unsigned int
    size() const;

    /** [N/m] */
    const double stiffness;

    /** Positions of the unknowns, as space.node_positions. */
    const Reservoir &reservoir;

    /**
     * Adds the second part of the mass on the right times (u, p).
     *
     * @param momentum,motion of the solid
     * @param water_momentum,water_motion of `size` unknowns; zero at the
     *   surface
     */
    void
    add_momentum(Vector       &momentum,
                 double       *water_momentum,
                 const Vector &motion,
                 const double *water_motion) const;

    /** Flux of a floor without solid below under a unit motion of a rigid base
     * in this direction. */
    void
    add_momentum_of_floor(Vector            &momentum,
                          double            *water_momentum,
                          const unsigned int direction) const;

    /** Sets entries at the surface to zero. */
    void
    clear_surface(double *water_motion) const;

  private:
    void
    add_momentum_of_flux(Vector &momentum, double *water_momentum) const;

    const std::vector<unsigned int> surface; // owned unknowns
    const PressureSolver            solver;
    std::vector<double>             weight; // sqrt(k Q) [sqrt(N/m m3/Pa)]
    mutable Vector                  flux, pressure, at_wall;
  };
} // namespace Voussoir

#endif
