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
      opening,      // times area [m3]
      slip,         // times area [m3]
      open_area,    // [m2]
      sliding_area, // [m2]
      pressure,     // resultant [N]
      shear_x,      // resultant, in global directions [N]
      shear_y,
      shear_z,
      resistance, // cohesion and friction of what may slip [N]
      driving_x,  // shear of what may slip, resultant [N]
      driving_y,
      driving_z,
      locked_area, // which keys hold [m2]
      force_x,     // resultant of pressure and shear [N]
      force_y,
      force_z,
      cohesion, // with the bond [N]
      friction, // coefficient of what is closed, times area [m2]
      n_quantities
    };
  }

  /** Relative motion along the surface [m]. */
  double
  slip_of(const ContactPoint &point);

  /** Zero if closed [m]. */
  double
  opening_of(const ContactPoint &point);

  /** Adds a point to the `n_quantities` sums of its surface.
   *  @tparam Number double or Sum */
  template <typename Number>
  void
  add_to_sums(const ContactPoint &point, Number *sums);

  /** What interfaces.csv says of a surface at a look. */
  constexpr unsigned int                                n_surface_columns = 9;
  constexpr std::array<const char *, n_surface_columns> surface_columns{
    {"largest opening [mm]",
     "mean opening [mm]",
     "largest slip [mm]",
     "mean slip [mm]",
     "open area [m2]",
     "sliding area [m2]",
     "normal force [MN]",
     "shear force [MN]",
     "sliding safety [-]"}};

  /**
   * The numbers of these columns.
   *
   * @param sums    of the surface over all ranks
   * @param largest opening and slip of its points [m]
   * @param area    of the surface [m2]
   */
  std::array<double, n_surface_columns>
  surface_values(const double *sums, const double *largest, const double area);

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
