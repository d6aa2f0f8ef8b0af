#ifndef voussoir_loads_reservoir_h
#define voussoir_loads_reservoir_h

#include <voussoir/base/log.h>
#include <voussoir/fem/acoustic_space.h>
#include <voussoir/loads/reservoir_end.h>
#include <voussoir/loads/reservoir_parameters.h>

#include <memory>

namespace Voussoir
{
  /**
   * Compressible water that meets the solid on a wet wall: its space, its
   * coefficients and its coupling to the solid. Its equation, with the pressure
   * impulse I = integral of p dt, 1/(rho c^2) M dp/dt + C p = -1/rho K I - sum
   * A.v ,  dI/dt = p, with the wall's velocity v and the nodal area vectors A
   * out of the water; C contains the radiating end, 1/(rho c) per area, and the
   * absorbing bottom; the end acts on the pressure less its free field
   * (EndMotion). The forces on the solid are A p. WaterMotion integrates the
   * equation in time.
   */
  class Reservoir
  {
  public:
    /**
     * @param water result of split_off_reservoir()
     *
     * Throws UserError if face sets are missing or nodes do not coincide.
     */
    Reservoir(const CoarseMesh          &water,
              const GridParameters      &grid,
              const ReservoirParameters &parameters,
              const Discretization      &solid,
              Log                       &log);

    const AcousticSpace space;
    const double        density;         // rho [kg/m3]
    const double        compressibility; // 1/(rho c^2) [1/Pa]

    /** Inverse of 1/(rho c^2) M, zero at the free surface [Pa/m3]. */
    Vector inverse_storage;

    /** C of each unknown [m3/(Pa s)]. */
    Vector dashpots;

    /** A wet node of the solid and the unknown of the water at the same
     *  position, as vectors of create_wall_vector() number it. */
    struct Pair
    {
      unsigned int         node, water;
      dealii::Tensor<1, 3> area; // out of the water [m2]
    };
    std::vector<Pair> pairs;

    /** Owned unknowns on the wet wall, with their areas. */
    struct WallNode
    {
      unsigned int         water;
      dealii::Tensor<1, 3> area;
    };
    std::vector<WallNode> wall_nodes;

    /** The same for the floor of the water without solid below, which moves
     *  with a rigid base. */
    std::vector<WallNode> floor_nodes;

    /** Owned unknowns with dashpots. */
    std::vector<unsigned int> lossy_nodes;

    /** The radiating end, or null. */
    std::unique_ptr<const ReservoirEnd> end;

    /** The wet nodes of the solid. */
    std::vector<unsigned int>
    wet_nodes() const;

    /** A zero vector whose ghosts are the unknowns that the pairs name. */
    Vector
    create_wall_vector() const;

    /** wall += A v of all wet nodes, on the ranks that own the unknowns of the
     *  water. */
    void
    gather_flux(Vector &wall, const Vector &velocity) const;

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

  private:
    void
    couple(const Discretization &solid);

    void
    find_floor(const std::vector<std::string> &open_sets);

    double
    find_stable_step() const;

    double largest_step = 0.;
    Vector wall; // layout of create_wall_vector()
  };
} // namespace Voussoir

#endif
