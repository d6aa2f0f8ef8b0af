#ifndef voussoir_output_interface_sums_h
#define voussoir_output_interface_sums_h

#include <voussoir/output/sliding_block.h>

namespace Voussoir
{
  /** Sums over the points of a surface in a sample. */
  namespace InterfaceSum
  {
    enum
    {
      opening,      // times area [m3]
      slip,         // times area [m3]
      open_area,    // [m2]
      sliding_area, // [m2]
      pressure,     // resultant [N]
      shear_x,      // resultant, in global directions [N]
      shear_y,
      shear_z,
      own_cohesion, // of points without keys, with the bond [N]
      own_pressure, // of these points, by which friction goes [N]
      own_friction, // that it gives [N]
      own_tension,  // carried by the bond of these points [N]
      driving_x,    // shear of these points, resultant [N]
      driving_y,
      driving_z,
      locked_area, // where keys prevent slip [m2]
      force_x,     // resultant of pressure and shear [N]
      force_y,
      force_z,
      cohesion, // with the bond [N]
      friction, // coefficient of closed points, times area [m2]
      moving_x, // velocity of the second side of closed points against the
      moving_y, // first, in global directions, times area [m3/s]
      moving_z,
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

  /** Values of a surface in interfaces.csv. */
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
   * The values of these columns.
   *
   * @param sums    of the surface over all ranks
   * @param largest opening and slip of its points [m]
   * @param area    of the surface [m2]
   */
  std::array<double, n_surface_columns>
  surface_values(const double *sums, const double *largest, const double area);

  /** Contact force of a plane on its block [N].
   *  @param sums over all ranks, of all surfaces one after the other */
  dealii::Tensor<1, 3>
  force_on_block(const SlidingBlock::Plane &plane, const double *sums);

  /**
   * Safety of a block: resistance of its planes over the driving force. Its
   * balance is M a = D + R with the contact forces R and all others D: weight,
   * water, uplift, thrust of the dam. Without slip its acceleration would be a
   * - a_s, where a_s is the acceleration of its slip, so that limit equilibrium
   * is that under D - M (a - a_s) = -(R - M a_s) . As long as nothing slides
   * this force is -R; while the block slides and friction limits R, the force
   * shows by how much the driving forces exceed the resistance of the planes.
   *
   * @param sums    over all ranks, of all surfaces one after the other
   * @param areas   of all surfaces [m2]
   * @param inertia M a_s [N]
   */
  double
  safety_from_sums(const SlidingBlock         &block,
                   const double               *sums,
                   const std::vector<double>  &areas,
                   const dealii::Tensor<1, 3> &inertia);

  /** Mean velocity of a block's slip, over the closed points of its planes;
   *  zero if no point is closed [m/s]. */
  dealii::Tensor<1, 3>
  slip_velocity(const SlidingBlock        &block,
                const double              *sums,
                const std::vector<double> &areas);
} // namespace Voussoir

#endif
