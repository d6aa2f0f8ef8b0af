#ifndef voussoir_analysis_scaled_materials_h
#define voussoir_analysis_scaled_materials_h

#include <voussoir/materials/material.h>

#include <functional>
#include <vector>

namespace Voussoir
{
  /** Materials with other moduli than those of the run while this exists. */
  class ScaledMaterials
  {
  public:
    /** @param factor on the moduli given */
    ScaledMaterials(const std::vector<Material *>                 &materials,
                    const std::function<double(const Material &)> &factor)
    {
      for (Material *material : materials)
        {
          kept.push_back(
            {material, material->stiffness_scale, material->strain_factor});
          material->stiffness_scale = material->strain_factor =
            factor(*material);
        }
    }

    ~ScaledMaterials()
    {
      for (const Kept &item : kept)
        {
          item.material->stiffness_scale = item.stiffness_scale;
          item.material->strain_factor   = item.strain_factor;
        }
    }

    ScaledMaterials(const ScaledMaterials &) = delete;
    ScaledMaterials &
    operator=(const ScaledMaterials &) = delete;

  private:
    struct Kept
    {
      Material *material;
      double    stiffness_scale, strain_factor;
    };
    std::vector<Kept> kept;
  };
} // namespace Voussoir

#endif
