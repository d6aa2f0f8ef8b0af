#ifndef voussoir_loads_reservoir_h
#define voussoir_loads_reservoir_h

#include <voussoir/fem/acoustic_space.h>
#include <voussoir/fem/nodal_terms.h>
#include <voussoir/loads/reservoir_parameters.h>

namespace Voussoir
{
  /**
   * Compressible water in motion with the dam, by explicit steps that alternate
   * with those of the solid.
   *
   * With the pressure impulse I = integral of p dt, the water moves with
   * -grad I / rho, and weakly
   *   1/(rho c^2) M dp/dt + C p = -1/rho K I - sum A.v ,  dI/dt = p,
   * with the wall's velocity v and the nodal area vectors A out of the water;
   * C holds the radiating end, 1/(rho c) per area, and the absorbing bottom.
   * The solid feels the forces A p. Pressures stand at the steps, I and v half
   * way between them, so that the exchange with the solid is central on both
   * sides and loses no energy:
   *   I+ = I- + dt p_n
   *   1/(rho c^2) M (p_(n+1) - p_n)/dt + C (p_(n+1) + p_n)/2
   *     = -1/rho K I+ - sum A.v+ .
   * The pressure is what the motion adds to the hydrostatic one.
   */
  class Reservoir
  {
  public:
    /**
     * @param water  as split_off_reservoir() makes it
     * @param terms  gets the wet nodes of the solid
     *
     * Throws UserError if face sets are not there or nodes do not meet.
     */
    Reservoir(const CoarseMesh          &water,
              const GridParameters      &grid,
              const ReservoirParameters &parameters,
              const Discretization      &solid,
              NodalTerms                &terms);

    const AcousticSpace space;

    /** Pressure p_n [Pa], impulse I_(n-1/2) [Pa s]; a checkpoint holds these
     *  and the sums of work. */
    Vector pressure, impulse;

    /** This rank's sums since the start: loss by radiation and at the bottom,
     *  work on the solid's own motion and on that of a rigid base [J]. */
    double loss = 0., work_on_solid = 0., work_on_base = 0.;

    /** The largest stable time step of the water by itself [s]. */
    double
    stable_step() const;

    /**
     * Adds A (1/(rho c^2) M)^-1 A^T u / (1 - (dt/dt_w)^2) for the water's own
     * limit dt_w: solid and water together are stable up to the dt at which the
     * solid is stable with this stiffness.
     */
    void
    add_coupling(Vector       &force,
                 const Vector &displacement,
                 const double  time_step) const;

    void
    prepare(const double time_step);

    /** Adds the forces of p_n to those of the terms. */
    void
    add_forces(NodalTerms &terms);

    /**
     * Advances to p_(n+1).
     * @param velocity      of the solid at the half step [m/s]
     * @param base_velocity of a rigid base, which is added to it
     */
    void
    advance(const Vector &velocity, const dealii::Tensor<1, 3> &base_velocity);

    /** Energy in the water at a step, of all ranks [J]. From rest it is less by
     *  the losses and the work than nothing. */
    double
    stored_energy() const;

    /** What the work on the solid is ahead of the work of the forces on it,
     *  dt/2 p_(n+1).A v+, of all ranks [J]. */
    double
    work_ahead(const Vector &velocity) const;

    /** Writes the pressure [MPa] to this VTU file. */
    void
    write(const std::string &file, const double time) const;

  private:
    void
    couple(const Discretization &solid, NodalTerms &terms);

    /** wall += A v of all wet nodes, on the ranks that own the water's. */
    void
    gather_flux(Vector &wall, const Vector &velocity) const;

    const double density, compressibility; // 1/(rho c^2) [1/Pa]
    Vector       inverse_storage; // of 1/(rho c^2) M, zero at the surface
    Vector       dashpots;        // C
    double       largest_step = 0., time_step = 0.;

    /** A wet node of the solid and the node of the water that it meets. */
    struct Pair
    {
      unsigned int         slot, node, water;
      dealii::Tensor<1, 3> area; // out of the water [m2]
    };
    std::vector<Pair> pairs;

    // Owned unknowns on the wet wall, with their areas, and those with losses.
    struct WallNode
    {
      unsigned int         water;
      dealii::Tensor<1, 3> area;
    };
    std::vector<WallNode>     wall_nodes;
    std::vector<unsigned int> lossy_nodes;
    std::vector<double>       last_wall_pressure, last_lossy_pressure;

    // p <- keep p - push (K I / rho + flux)
    Vector keep, push;
    Vector stiffness;           // K I
    Vector wall_pressure, flux; // with the unknowns that the pairs name
  };
} // namespace Voussoir

#endif
