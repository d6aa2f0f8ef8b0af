// Forces of a cluster that move none of its nodes: where contact constraints
// are linearly dependent, contact forces are determined up to these.

#include <voussoir/constraints/contact_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Share of the distance to a limit that remains, so that no round-off leads
    // beyond it.
    constexpr double margin = 1e-6;

    // Part of the largest force by which a limit may be exceeded.
    constexpr double tolerated = 1e-11;

    // Norm of a row, orthogonal to the others, below which it depends on them.
    constexpr double dependent = 1e-10;

    // Part of the sum of F^2 / A that self-equilibrated forces may have. Below
    // it the forces are kept: the next search begins at them, and they should
    // change little from step to step.
    constexpr double largest_share = 0.5;

    /** Admissible changes of the force of a point that keep its status and
     *  motion. */
    class FreeForce
    {
    public:
      explicit FreeForce(const ContactPoint &point)
        : limits(point.limits)
        , force(point.force)
        , fixed(!point.joined || point.status == ContactStatus::open)
        , slides(point.status == ContactStatus::sliding)
        , under_pressure(force[0] >= 0.)
      {
        // closed by a part of its cohesion, which depends on the motion; or
        // without any force in the direction of its slip
        if (slides && (shear() < (1. - 1e-9) * limits.shear(false, force[0]) ||
                       (shear() == 0. && limits.with_pressure() > 0.)))
          fixed = true;
      }

      /** Unit vectors along which the force keeps its component. */
      std::vector<Tensor<1, 3>>
      constraints() const
      {
        std::vector<Tensor<1, 3>> result;
        if (fixed)
          for (unsigned int d = 0; d < 3; ++d)
            {
              result.emplace_back();
              result.back()[d] = 1.;
            }
        else if (slides)
          {
            // along the line of its limit of shear, in the direction of slip
            Tensor<1, 3>       across;
            const Tensor<1, 3> along = limit_line();
            across[1]                = -along[2];
            across[2]                = along[1];
            if (across.norm() == 0.)
              across[1] = 1.;
            result.push_back(across / across.norm());
            result.push_back(
              cross_product_3d(along / along.norm(), result.front()));
          }
        if (normal_fixed && !fixed)
          result.push_back(Tensor<1, 3>({1., 0., 0.}));
        return result;
      }

      /** Largest share of a change that the limits admit, at most one. */
      double
      admissible(const Tensor<1, 3> &change) const
      {
        if (fixed)
          return 1.;
        return std::min({1.,
                         normal_fixed ? 1. : to_bound(change),
                         slides || limits.locked ? 1. : to_slip(change)});
      }

      void
      add(const double part, const Tensor<1, 3> &change)
      {
        if (!fixed)
          force += part * change;
      }

      /** Excludes further changes along a direction in which a limit has been
       *  reached. */
      void
      stop(const Tensor<1, 3> &change)
      {
        const bool may_slip = !slides && !limits.locked;
        if (!normal_fixed && !(may_slip && to_slip(change) < to_bound(change)))
          normal_fixed = true;
        else if (may_slip)
          slides = true;
        else
          fixed = true;
      }

      /** Whether the force is within its limits. */
      bool
      is_admissible(const double tolerance) const
      {
        return fixed ||
               (force[0] >= limits.opening_force() - tolerance &&
                (limits.locked ||
                 shear() <= limits.shear(false, force[0]) + tolerance));
      }

      const Tensor<1, 3> &
      value() const
      {
        return force;
      }

    private:
      double
      shear() const
      {
        return std::sqrt(force[1] * force[1] + force[2] * force[2]);
      }

      double
      friction() const
      {
        return under_pressure ? limits.with_pressure() : 0.;
      }

      /** Smallest part of a change at which the normal force reaches zero or
       *  its lower limit. */
      double
      to_bound(const Tensor<1, 3> &change) const
      {
        const double lowest = under_pressure ?
                                std::max(limits.opening_force(), 0.) :
                                limits.opening_force();
        if (change[0] < 0.)
          return std::max(0., (lowest - force[0]) / change[0]);
        if (change[0] > 0. && !under_pressure)
          return -force[0] / change[0];
        return std::numeric_limits<double>::infinity();
      }

      /** Change of the force with the pressure along which the shear keeps its
       *  direction and its share of the limit. */
      Tensor<1, 3>
      limit_line() const
      {
        const double limit = limits.shear(false, force[0]);
        Tensor<1, 3> result({1., 0., 0.});
        for (unsigned int d = 1; d < 3 && limit > 0.; ++d)
          result[d] = friction() * force[d] / limit;
        return result;
      }

      /** Smallest part s of a change t' of the shear t and L' of its limit L at
       *  which it slips, |t + s t'| = L + s L'. */
      double
      to_slip(const Tensor<1, 3> &change) const
      {
        const double limit       = limits.shear(false, force[0]),
                     limit_slope = friction() * change[0];
        const double a = change[1] * change[1] + change[2] * change[2] -
                         limit_slope * limit_slope,
                     b = force[1] * change[1] + force[2] * change[2] -
                         limit * limit_slope,
                     c      = std::min(0.,
                                  force[1] * force[1] + force[2] * force[2] -
                                    limit * limit);
        const double square = b * b - a * c;
        if (b > 0. && square >= 0.)
          return -c / (b + std::sqrt(square));
        if (b <= 0. && a > 0.)
          return (std::sqrt(square) - b) / a;
        return std::numeric_limits<double>::infinity();
      }

      const ContactLimits limits;
      Tensor<1, 3>        force;
      bool                fixed, slides, normal_fixed = false;
      const bool          under_pressure; // and stays so
    };


    /** Subtracts the components of @p v along an orthonormal basis. */
    void
    project(std::vector<double>                    &v,
            const std::vector<std::vector<double>> &basis)
    {
      for (const std::vector<double> &direction : basis)
        {
          double along = 0.;
          for (std::size_t i = 0; i < v.size(); ++i)
            along += v[i] * direction[i];
          for (std::size_t i = 0; i < v.size(); ++i)
            v[i] -= along * direction[i];
        }
    }
  } // namespace


  // Finds, of all forces with the same motion, those with the least sum of F^2
  // / A. Follows the gradient of that sum in the space of self-equilibrated
  // forces, on the surface of the constraints, up to the first point that would
  // slip or open, which is a constraint from there on. Otherwise forces may
  // grow from step to step, as in a ring of points whose friction cones have a
  // direction in common.
  void
  ContactSolver::remove_self_equilibrated(Points        &points,
                                          const Cluster &cluster,
                                          const double   smallest_slip)
  {
    const auto        &basis = cluster.self_equilibrated;
    const unsigned int m     = basis.size();
    double             self = 0., whole = 0.; // sums of F^2 / A
    for (const std::vector<double> &direction : basis)
      {
        double along = 0.;
        for (unsigned int k = 0; k < cluster.n_points; ++k)
          {
            const ContactPoint &point = points[cluster.first_point + k];
            for (unsigned int d = 0; d < 3; ++d)
              along +=
                direction[3 * k + d] * point.force[d] / std::sqrt(point.area);
          }
        self += along * along;
      }
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      {
        const ContactPoint &point = points[cluster.first_point + k];
        whole += point.force.norm_square() / point.area;
      }
    if (self <= largest_share * whole)
      return;

    find_moves(points, cluster);
    std::vector<double>    root_of_area;
    std::vector<FreeForce> forces;
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      {
        ContactPoint &point = points[cluster.first_point + k];
        if (point.status == ContactStatus::sliding &&
            tangential_norm(gaps[k] + relative_move(cluster, point)) <=
              smallest_slip)
          point.status = ContactStatus::sticking;
        forces.emplace_back(point);
        root_of_area.push_back(std::sqrt(point.area));
      }

    std::vector<Tensor<1, 3>> change(cluster.n_points);
    for (unsigned int i = 0; i < 3 * cluster.n_points; ++i)
      {
        std::vector<double> way(m); // coefficients of the basis
        for (unsigned int j = 0; j < m; ++j)
          for (unsigned int k = 0; k < cluster.n_points; ++k)
            for (unsigned int d = 0; d < 3; ++d)
              way[j] -=
                basis[j][3 * k + d] * forces[k].value()[d] / root_of_area[k];

        std::vector<std::vector<double>> constraints;
        for (unsigned int k = 0; k < cluster.n_points; ++k)
          for (const Tensor<1, 3> &direction : forces[k].constraints())
            {
              std::vector<double> row(m);
              for (unsigned int j = 0; j < m; ++j)
                for (unsigned int d = 0; d < 3; ++d)
                  row[j] += basis[j][3 * k + d] * direction[d];
              // twice, as what the first leaves of a dependent row is round-off
              // in any direction, which is no constraint
              project(row, constraints);
              project(row, constraints);
              double size = 0.;
              for (const double value : row)
                size += value * value;
              size = std::sqrt(size);
              if (size < dependent)
                continue;
              for (double &value : row)
                value /= size;
              constraints.push_back(std::move(row));
            }
        if (constraints.size() == m)
          break;
        project(way, constraints);

        double part = 1.;
        for (unsigned int k = 0; k < cluster.n_points; ++k)
          {
            change[k] = Tensor<1, 3>();
            for (unsigned int j = 0; j < m; ++j)
              for (unsigned int d = 0; d < 3; ++d)
                change[k][d] += way[j] * basis[j][3 * k + d] * root_of_area[k];
            part = std::min(part, forces[k].admissible(change[k]));
          }
        for (unsigned int k = 0; k < cluster.n_points; ++k)
          {
            const bool ends =
              part < 1. && forces[k].admissible(change[k]) <= part;
            forces[k].add(part < 1. ? (1. - margin) * part : 1., change[k]);
            if (ends)
              forces[k].stop(change[k]);
          }
        if (part == 1.)
          break;
      }
    double largest = 0.; // previous force, whose round-off the remainder has
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      largest = std::max(largest, points[cluster.first_point + k].force.norm());
    if (!std::all_of(forces.begin(), forces.end(), [&](const FreeForce &force) {
          return force.is_admissible(tolerated * largest);
        }))
      return;
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      if (points[cluster.first_point + k].joined)
        points[cluster.first_point + k].force = forces[k].value();
  }
} // namespace Voussoir
