#include <voussoir/base/sum.h>
#include <voussoir/output/interface_sums.h>

namespace Voussoir
{
  using namespace dealii;
  using namespace InterfaceSum;

  double
  slip_of(const ContactPoint &point)
  {
    return std::hypot(point.gap[1], point.gap[2]);
  }


  double
  opening_of(const ContactPoint &point)
  {
    return std::max(point.gap[0], 0.);
  }


  template <typename Number>
  void
  add_to_sums(const ContactPoint &point, Number *sum)
  {
    const Tensor<1, 3> &F      = point.force;
    const Tensor<1, 3>  global = F * point.frame;
    const bool          open   = point.status == ContactStatus::open;
    sum[opening] += point.area * opening_of(point);
    sum[slip] += point.area * slip_of(point);
    sum[open_area] += open ? point.area : 0.;
    sum[sliding_area] +=
      point.status == ContactStatus::sliding ? point.area : 0.;
    sum[pressure] += F[0];
    for (unsigned int d = 0; d < 3; ++d)
      {
        sum[shear_x + d] += global[d] - F[0] * point.frame[0][d];
        sum[force_x + d] += global[d];
      }
    const ContactLimits &limits = point.limits;
    if (limits.locked)
      sum[locked_area] += point.area;
    else
      {
        sum[own_cohesion] += limits.bond + (open ? 0. : limits.cohesion);
        if (!open)
          {
            sum[own_pressure] += point.mean_pressure;
            sum[own_friction] += limits.friction * point.mean_pressure;
          }
        sum[own_tension] += std::max(-F[0], 0.);
        for (unsigned int d = 0; d < 3; ++d)
          sum[driving_x + d] += global[d] - F[0] * point.frame[0][d];
      }
    sum[cohesion] += limits.bond + (open ? 0. : limits.cohesion);
    sum[friction] += open ? 0. : limits.friction * point.area;
    const Tensor<1, 3> velocity = point.velocity * point.frame;
    for (unsigned int d = 0; d < 3 && !open; ++d)
      sum[moving_x + d] += point.area * velocity[d];
  }

  template void
  add_to_sums(const ContactPoint &, double *);

  template void
  add_to_sums(const ContactPoint &, Sum *);


  std::array<double, n_surface_columns>
  surface_values(const double *sum, const double *largest, const double area)
  {
    // Safety of the plane as a whole, (c A + mu N) / T, where tension of the
    // bond reduces N. Infinite without shear or with nearly none, as in an open
    // joint without keys, or one whose keys prevent slip.
    const double friction_of_plane =
      sum[own_pressure] > sum[own_tension] ?
        sum[own_friction] * (1. - sum[own_tension] / sum[own_pressure]) :
        0.;
    const double       resistance = sum[own_cohesion] + friction_of_plane;
    const Tensor<1, 3> shear({sum[shear_x], sum[shear_y], sum[shear_z]}),
      driving({sum[driving_x], sum[driving_y], sum[driving_z]});
    const double safety = driving.norm() > 1e-6 * resistance ?
                            resistance / driving.norm() :
                            std::numeric_limits<double>::infinity();
    return {{1e3 * largest[0],
             1e3 * sum[opening] / area,
             1e3 * largest[1],
             1e3 * sum[slip] / area,
             sum[open_area],
             sum[sliding_area],
             1e-6 * sum[pressure],
             1e-6 * shear.norm(),
             safety}};
  }


  Tensor<1, 3>
  force_on_block(const SlidingBlock::Plane &plane, const double *sums)
  {
    const double *sum = sums + n_quantities * plane.surface;
    return plane.side *
           Tensor<1, 3>({sum[force_x], sum[force_y], sum[force_z]});
  }


  double
  safety_from_sums(const SlidingBlock        &block,
                   const double              *sums,
                   const std::vector<double> &areas,
                   const Tensor<1, 3>        &inertia)
  {
    Tensor<1, 3>              force = -inertia;
    std::vector<SlidingPlane> closed;
    for (const SlidingBlock::Plane &plane : block.planes)
      {
        const double *sum  = sums + n_quantities * plane.surface;
        const double  area = areas[plane.surface];
        // the block cannot slide as long as keys prevent slip
        if (sum[locked_area] > 0.)
          return std::numeric_limits<double>::infinity();
        force += force_on_block(plane, sums);
        const double closed_area = area - sum[open_area];
        if (closed_area > 1e-9 * area)
          closed.push_back(
            {plane.normal, sum[friction] / closed_area, sum[cohesion]});
      }
    return sliding_safety(closed, force);
  }


  Tensor<1, 3>
  slip_velocity(const SlidingBlock        &block,
                const double              *sums,
                const std::vector<double> &areas)
  {
    Tensor<1, 3> moving;
    double       closed = 0., whole = 0.;
    for (const SlidingBlock::Plane &plane : block.planes)
      {
        const double *sum = sums + n_quantities * plane.surface;
        for (unsigned int d = 0; d < 3; ++d)
          moving[d] += plane.side * sum[moving_x + d];
        closed += areas[plane.surface] - sum[open_area];
        whole += areas[plane.surface];
      }
    return closed > 1e-9 * whole ? moving / closed : Tensor<1, 3>();
  }
} // namespace Voussoir
