#ifndef voussoir_base_gravity_h
#define voussoir_base_gravity_h

namespace Voussoir
{
  /** The value of g for water, weight, records and peak accelerations [m/s2].
   */
  constexpr double standard_gravity = 9.81;
} // namespace Voussoir

#endif
