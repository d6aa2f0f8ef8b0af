#ifndef voussoir_output_material_memory_h
#define voussoir_output_material_memory_h

#include <voussoir/output/observer.h>

#include <deal.II/lac/vector.h>

namespace Voussoir
{
  /**
   * What the memories of all materials tell (damage, plastic strain), by name:
   * the mean of the integration points of each active cell; zero in cells whose
   * material has no such thing.
   */
  std::map<std::string, dealii::Vector<float>>
  memory_of_cells(const ObservedModel &model);

  /** The crack that is widest against its cell. */
  struct WidestCrack
  {
    double opening = 0.; // [m]
    double share   = 0.; // of the width of the cell across it
  };

  /** Of all materials that tell of cracks; all ranks must call this together.
   */
  WidestCrack
  widest_crack(const ObservedModel &model);

  /**
   * Of each material with memory: the share of its volume that has left the
   * elastic range, energy lost in it [J], largest value of what it tells. All
   * ranks must call this together.
   *
   * @param names of the materials
   */
  nlohmann::json
  memory_summary(const ObservedModel            &model,
                 const std::vector<std::string> &names);
} // namespace Voussoir

#endif
