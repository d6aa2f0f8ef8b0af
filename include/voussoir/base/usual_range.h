#ifndef voussoir_base_usual_range_h
#define voussoir_base_usual_range_h

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace Voussoir
{
  /** Quantities whose usual range shows whether the unit is right. */
  enum class Usual
  {
    modulus,
    density,
    expansion,
    tensile_strength,
    tensile_strength_or_none,
    compressive_strength,
    fracture_energy,
    crushing_energy,
    cohesion,
    cut_off,
    friction_angle,
    dilation_angle,
    wave_angle,
    water_density,
    water_gravity,
    sound_speed,
    silt_weight,
    silt_friction_angle,
    overload,
    friction_coefficient,
    interface_cohesion,
    interface_tension,
    shear_fracture_energy,
    gap,
    key_depth,
    steel_modulus,
    steel_strength,
    bar_length,
    elevation,
    acceleration,
    displacement,
    force,
    pressure,
    relaxation_time,
    compression_coefficient,
    demand_capacity_ratio,
    accumulated_time
  };

  /** The last sentence in the description of an entry: the usual range of the
   * quantity. unusual_values() compares values with it. */
  std::string
  usually(const Usual quantity);

  /** A sentence for each entry whose value is outside its usual range, most
   * often because it is in another unit. Throws UserError if no case can be
   * computed with the value. */
  std::vector<std::string>
  unusual_values(const dealii::ParameterHandler &prm);
} // namespace Voussoir

#endif
