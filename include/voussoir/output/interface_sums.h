#ifndef voussoir_output_interface_sums_h
#define voussoir_output_interface_sums_h

#include <voussoir/output/sliding_block.h>

namespace Voussoir
{
  /** What is summed over the points of a surface at a look. */
  namespace InterfaceSum
  {
    enum Quantity
    {
      opening, // times area [m3]
      slip,    // times area [m3]
      open_area,
      sliding_area,
      pressure, // resultant [N]
      shear_x,  // resultant, in global directions [N]
      shear_y,
      shear_z,
      resistance,      // cohesion and friction [N]
      shear_of_points, // sum of sizes [N]
      force_x,         // resultant of pressure and shear [N]
      force_y,
      force_z,
      cohesion, // with the bond [N]
      friction, // coefficient of what is closed, times area [m2]
      n_quantities
    };
  }

  double
  slip_of(const ContactPoint &point);

  double
  opening_of(const ContactPoint &point);

  /** Adds a point to the sums of its surface. */
  void
  add_to_sums(const ContactPoint &point, double *sums);

  /**
   * Safety of a block now.
   *
   * @param sums  over all ranks, of all surfaces one after the other
   * @param areas of all surfaces [m2]
   */
  double
  safety_from_sums(const SlidingBlock        &block,
                   const double              *sums,
                   const std::vector<double> &areas);
} // namespace Voussoir

#endif
