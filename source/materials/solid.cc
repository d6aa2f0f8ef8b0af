#include <voussoir/materials/solid.h>

namespace Voussoir
{
  namespace
  {
    std::vector<bool>
    have_memory(const std::vector<const Material *> &materials)
    {
      return for_each_material(materials, [](const Material &material) {
        return material.n_history() > 0;
      });
    }


    std::vector<double>
    inertial_densities(const std::vector<const Material *> &materials)
    {
      return for_each_material(materials, [](const Material &material) {
        return material.inertial_density();
      });
    }


    // Rock of reduced inertia takes no inertial earthquake force.
    std::vector<double>
    driven_densities(const std::vector<const Material *> &materials)
    {
      return for_each_material(materials, [](const Material &material) {
        return material.inertia_factor < 1. ? 0. : material.density;
      });
    }
  } // namespace


  Solid::Solid(const Grid                          &grid,
               const DiscretizationParameters      &parameters,
               const std::vector<Support>          &supports,
               const std::vector<const Material *> &materials)
    : materials(materials)
    , discretization(grid, parameters, supports, have_memory(materials))
    , mass(discretization,
           inertial_densities(materials),
           driven_densities(materials))
    , internal_force(discretization,
                     std::vector<const CellKernel *>(materials.begin(),
                                                     materials.end()),
                     std::vector<double>(materials.size(), 1.))
  {}
} // namespace Voussoir
