#include <voussoir/constraints/contact_point.h>

#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** The normal force if the gap without it is @p gap. */
    double
    normal_force(const double         gap,
                 const double         flexibility,
                 const ContactLimits &limits,
                 bool                &open)
    {
      if (flexibility == 0.) // both nodes are held
        {
          open = gap > 0.;
          return 0.;
        }
      const double closing = -gap / flexibility;
      open = closing < (limits.opening > 0. ? 0. : -limits.tension);
      if (!open)
        return closing;
      if (limits.opening > 0. && limits.tension > 0.)
        // an opened bond: g = gap + D F and F = -tension g / opening
        return std::max(-gap / (limits.opening / limits.tension + flexibility),
                        -limits.tension);
      return -limits.tension;
    }


    /**
     * The shear force of size @p limit against the slip s + S F that remains:
     * F = -limit d with (lambda + limit S) d = s, |d| = 1 (Newton's iteration
     * for 1 / |d(lambda)|, which is nearly linear).
     */
    Tensor<1, 2>
    sliding_force(const Tensor<1, 2> &s,
                  const Flexibility  &flexibility,
                  const double        limit)
    {
      if (limit == 0.)
        return Tensor<1, 2>();
      const std::array<double, 2> along{
        {s * flexibility.axes[0], s * flexibility.axes[1]}};
      std::array<double, 2> d{{0., 0.}};
      double                lambda = 0.;
      for (unsigned int i = 0; i < 50; ++i)
        {
          double square = 0., slope = 0.;
          for (unsigned int a = 0; a < 2; ++a)
            {
              const double stiffness =
                lambda + limit * flexibility.tangential[a];
              d[a] = stiffness > 0. ? along[a] / stiffness : 0.;
              square += d[a] * d[a];
              slope += stiffness > 0. ? d[a] * d[a] / stiffness : 0.;
            }
          const double size = std::sqrt(square);
          if (size <= 1. + 1e-15)
            break;
          lambda += square / slope * (size - 1.);
        }
      const double size = std::hypot(d[0], d[1]);
      return -limit / size *
             (d[0] * flexibility.axes[0] + d[1] * flexibility.axes[1]);
    }


    /** The force with this normal part, and the shear that then resists slip
     *  up to a limit. */
    Tensor<1, 3>
    shear_force(const Tensor<1, 3> &b,
                const Flexibility  &flexibility,
                const double        normal,
                const double        limit,
                bool               &slides)
    {
      Tensor<1, 2> s, shear;
      s[0] = b[1] + flexibility.full[1][0] * normal;
      s[1] = b[2] + flexibility.full[2][0] * normal;
      for (unsigned int a = 0; a < 2; ++a)
        if (flexibility.tangential[a] > 0.)
          shear -= s * flexibility.axes[a] / flexibility.tangential[a] *
                   flexibility.axes[a];
      slides = shear.norm() > limit;
      if (slides)
        shear = sliding_force(s, flexibility, limit);
      Tensor<1, 3> force;
      force[0] = normal;
      force[1] = shear[0];
      force[2] = shear[1];
      return force;
    }


    /** Closes a gap(normal force) that changes its sign between two forces, by
     *  the Illinois form of false position. */
    template <typename Gap>
    void
    close_gap(const Gap &gap, double x0, double g0, double x1, double g1)
    {
      const double size = std::max(std::abs(g0), std::abs(g1));
      for (unsigned int i = 0; i < 100; ++i)
        {
          const double x = g1 == g0 ? x1 : x1 - g1 * (x1 - x0) / (g1 - g0);
          const double g = gap(x);
          if (std::abs(g) <= 1e-15 * size || x == x1)
            return;
          if (g * g1 < 0.)
            {
              x0 = x1;
              g0 = g1;
            }
          else
            g0 *= 0.5;
          x1 = x;
          g1 = g;
        }
    }
  } // namespace


  double
  ContactLimits::shear(const bool open, const double force) const
  {
    if (locked)
      return std::numeric_limits<double>::max();
    return open ? bond : bond + cohesion + friction * std::max(force, 0.);
  }


  Flexibility::Flexibility(const Tensor<2, 3> &flexibility)
    : full(flexibility)
  {
    const SymmetricTensor<2, 3> symmetric = symmetrize(full);
    const auto                  system =
      eigenvectors(symmetric, SymmetricTensorEigenvectorMethod::jacobi);
    for (const auto &[value, vector] : system)
      if (value > 1e-12 * system[0].first)
        inverse += outer_product(vector, vector) / value;

    const double mean       = 0.5 * (full[1][1] + full[2][2]),
                 difference = 0.5 * (full[1][1] - full[2][2]),
                 radius     = std::hypot(difference, full[1][2]);
    const double angle      = 0.5 * std::atan2(full[1][2], difference);
    tangential              = {{mean + radius, mean - radius}};
    if (tangential[1] < 1e-12 * tangential[0])
      tangential[1] = 0.;
    axes[0][0] = axes[1][1] = std::cos(angle);
    axes[0][1]              = std::sin(angle);
    axes[1][0]              = -axes[0][1];
  }


  ContactForce
  solve_contact(const Tensor<1, 3>  &b,
                const Flexibility   &flexibility,
                const ContactLimits &limits)
  {
    const auto &D = flexibility.full;

    // closed without slip
    ContactForce result;
    result.force      = -(flexibility.inverse * b);
    result.status     = ContactStatus::sticking;
    Tensor<1, 3> &F   = result.force;
    const double  low = limits.opening > 0. ? 0. : -limits.tension;
    if ((D[0][0] > 0. || b[0] <= 0.) && F[0] >= low &&
        std::hypot(F[1], F[2]) <= limits.shear(false, F[0]))
      return result;

    // sets the shear force under this normal force and returns the gap
    const auto gap = [&](const double normal, const double limit) {
      bool slides = false;
      F           = shear_force(b, flexibility, normal, limit, slides);
      if (slides)
        result.status = ContactStatus::sliding;
      else
        result.status = ContactStatus::sticking;
      return b[0] + D[0] * F;
    };
    const auto closed_gap = [&](const double normal) {
      return gap(normal, limits.shear(false, normal));
    };

    double below = low, gap_below = closed_gap(below);
    if (gap_below < 0. && D[0][0] > 0.)
      {
        // the pressure that closes it, between two bounds
        double above = low - gap_below / D[0][0], gap_above = closed_gap(above);
        for (unsigned int i = 0; i < 100 && gap_above < 0.; ++i)
          {
            below     = above;
            gap_below = gap_above;
            above += std::max(above - low, -gap_above / D[0][0]);
            gap_above = closed_gap(above);
          }
        close_gap(closed_gap, below, gap_below, above, gap_above);
        return result;
      }
    if (D[0][0] == 0. && b[0] <= 0.)
      {
        closed_gap(0.);
        return result;
      }

    // open: bond and shear in turn; once is enough if they are not coupled
    bool open = true;
    F[1] = F[2] = 0.;
    for (unsigned int i = 0; i < 200; ++i)
      {
        const Tensor<1, 3> before = F;
        const double       normal = normal_force(
          b[0] + D[0][1] * F[1] + D[0][2] * F[2], D[0][0], limits, open);
        gap(std::min(normal, 0.), limits.shear(true, normal));
        if ((F - before).norm() <= 1e-15 * F.norm())
          break;
      }
    if (b[0] + D[0] * F < 0. && !limits.locked)
      {
        // with its cohesion it would open, without it not: it closes without
        // pressure, with as much of the cohesion as keeps it so
        const double all     = limits.bond + limits.cohesion;
        const auto   partial = [&](const double limit) {
          return gap(low, limit);
        };
        close_gap(
          partial, limits.bond, partial(limits.bond), all, partial(all));
        return result;
      }
    result.status = ContactStatus::open;
    return result;
  }


  ContactForce
  solve_contact(const Tensor<1, 3>  &b,
                const double         flexibility,
                const ContactLimits &limits)
  {
    ContactForce result;
    bool         open  = false;
    result.force[0]    = normal_force(b[0], flexibility, limits, open);
    result.status      = open ? ContactStatus::open : ContactStatus::sticking;
    const double limit = limits.shear(open, result.force[0]);
    if (limit == 0. || flexibility == 0.)
      {
        if (!open && flexibility > 0.)
          result.status = ContactStatus::sliding;
        return result;
      }
    const double slip = std::sqrt(b[1] * b[1] + b[2] * b[2]);
    double       size = 1. / flexibility;
    if (slip > limit * flexibility)
      {
        size = limit / slip;
        if (!open)
          result.status = ContactStatus::sliding;
      }
    result.force[1] = -size * b[1];
    result.force[2] = -size * b[2];
    return result;
  }
} // namespace Voussoir
