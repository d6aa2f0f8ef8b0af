#ifndef voussoir_loads_water_motion_h
#define voussoir_loads_water_motion_h

#include <voussoir/loads/end_motion.h>
#include <voussoir/loads/nodal_load.h>
#include <voussoir/loads/reservoir.h>
#include <voussoir/loads/rigid_base.h>

#include <optional>

namespace Voussoir
{
  /**
   * Compressible water in motion with the dam, by explicit steps that alternate
   * with those of the solid. Pressures are known at the steps, the impulse and
   * the velocity of the solid half way between them, so that the exchange with
   * the solid is central on both sides and loses no energy:
   *   I+ = I- + dt p_n
   *   1/(rho c^2) M (p_(n+1) - p_n)/dt + C (p_(n+1) + p_n)/2
   *     = -1/rho K I+ - sum A.v+ ,
   * with the symbols of Reservoir, and at the radiating end with the flux of
   * EndMotion. The pressure is the hydrodynamic one, without the hydrostatic
   * part.
   */
  class WaterMotion : public NodalLoad
  {
  public:
    /** @param base under the solid; must live as long as this */
    WaterMotion(const Reservoir &reservoir,
                const RigidBase &base,
                const double     time_step);

    const Reservoir &reservoir;

    /** Pressure p_n [Pa], impulse I_(n-1/2) [Pa s]; a checkpoint holds these,
     *  the motion at the end and the loss. */
    Vector pressure, impulse;

    /** The flux through the radiating end, if there is one. */
    std::optional<EndMotion> end;

    /** This rank's sums since the start: loss by radiation, of which the free
     *  field may bring some back, and at the bottom, work on the solid's own
     *  motion and on that of a rigid base [J]. */
    double loss = 0., work_on_solid = 0., work_on_base = 0.;

    /** Adds the forces of p_n. */
    void
    add_forces(const double time, NodalForces &forces) override;

    /** Advances to p_(n+1). */
    void
    end_step(const State &state) override;

    /**
     * Advances to p_(n+1).
     * @param velocity      of the solid at the half step [m/s]
     * @param base_velocity of a rigid base, which is added to it
     */
    void
    advance(const Vector &velocity, const dealii::Tensor<1, 3> &base_velocity);

    /** Energy in the water at a step, of all ranks [J]. In a motion that starts
     *  from rest this energy is minus the sum of losses and work. */
    double
    stored_energy() const;

    /** Difference between the work on the solid and the work of the forces on
     *  it, as these are half a step apart, dt/2 p_(n+1).A v+, of all ranks [J].
     */
    double
    work_ahead(const Vector &velocity) const;

  private:
    const RigidBase    &base;
    const double        time_step;
    std::vector<double> last_wall_pressure, last_floor_pressure,
      last_lossy_pressure, last_end_pressure;

    // p <- keep p - push (K I / rho + flux)
    Vector keep, push;
    Vector stiffness; // K I
    Vector wall_pressure, flux;
  };
} // namespace Voussoir

#endif
