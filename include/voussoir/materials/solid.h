#ifndef voussoir_materials_solid_h
#define voussoir_materials_solid_h

#include <voussoir/fem/internal_force.h>
#include <voussoir/fem/lumped_mass.h>
#include <voussoir/materials/material.h>

namespace Voussoir
{
  /** Dam and foundation: unknowns, materials, mass and internal force. No
   *  computation changes it. */
  class Solid
  {
  public:
    /** @param grid,materials must live as long as this; materials by number */
    Solid(const Grid                          &grid,
          const DiscretizationParameters      &parameters,
          const std::vector<Support>          &supports,
          const std::vector<const Material *> &materials);

    const std::vector<const Material *> materials;
    const Discretization                discretization;
    const LumpedMass                    mass;

    /** With the moduli as given; a run and the static stages use it with their
     *  own factors. */
    const InternalForce internal_force;

    const Grid &
    grid() const
    {
      return discretization.grid;
    }

    const Material &
    material_of(const Grid::Cell &cell) const
    {
      return *materials[grid().material(cell)];
    }
  };
} // namespace Voussoir

#endif
