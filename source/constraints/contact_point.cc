#include <voussoir/constraints/contact_point.h>

#include <deal.II/base/symmetric_tensor.h>

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Shares of a motion: the share that is neglected, and the residual of a
    // singular Delassus operator.
    constexpr double round_off = 1e-14, left_over = 1e-9;

    // Share of the largest compliance below which a direction is fixed.
    constexpr double fixed = 1e-12;


    /** The normal force if the gap without it is @p gap. */
    double
    normal_force(const double         gap,
                 const double         delassus,
                 const ContactLimits &limits,
                 bool                &open)
    {
      if (delassus == 0.) // both nodes are fixed
        {
          open = gap > 0.;
          return 0.;
        }
      const double closing = -gap / delassus;
      open                 = closing < limits.opening_force();
      if (!open)
        return closing;
      if (limits.opening > 0. && limits.tension > 0.)
        // an opened bond: g = gap + D F and F = -tension g / opening
        return std::max(-gap / (limits.opening / limits.tension + delassus),
                        -limits.tension);
      return -limits.tension;
    }


    /**
     * The shear force of size @p limit against the slip s + S F that remains:
     * F = -limit d with (lambda + limit S) d = s, |d| = 1 (Newton's iteration
     * for 1 / |d(lambda)|, which is nearly linear).
     */
    Tensor<1, 2>
    sliding_force(const Tensor<1, 2>     &s,
                  const DelassusOperator &delassus,
                  const double            limit)
    {
      if (limit == 0.)
        return Tensor<1, 2>();
      // a force without effect, such as friction under vanishing pressure
      if (const double slip = s.norm();
          limit * delassus.tangential[0] <= round_off * slip)
        return -limit / slip * s;
      const std::array<double, 2> along{
        {s * delassus.axes[0], s * delassus.axes[1]}};
      std::array<double, 2> d{{0., 0.}};
      double                lambda = 0.;
      for (unsigned int i = 0; i < 50; ++i)
        {
          double square = 0., slope = 0.;
          for (unsigned int a = 0; a < 2; ++a)
            {
              const double stiffness = lambda + limit * delassus.tangential[a];
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
             (d[0] * delassus.axes[0] + d[1] * delassus.axes[1]);
    }


    /** The force with this normal part, and the shear that then resists slip
     *  up to a limit. */
    Tensor<1, 3>
    shear_force(const Tensor<1, 3>     &b,
                const DelassusOperator &delassus,
                const double            normal,
                const double            limit,
                bool                   &slides)
    {
      Tensor<1, 2> s, shear;
      s[0] = b[1] + delassus.full[1][0] * normal;
      s[1] = b[2] + delassus.full[2][0] * normal;
      for (unsigned int a = 0; a < 2; ++a)
        if (delassus.tangential[a] > 0.)
          shear -=
            s * delassus.axes[a] / delassus.tangential[a] * delassus.axes[a];
      slides = shear.norm() > limit;
      if (slides)
        shear = sliding_force(s, delassus, limit);
      Tensor<1, 3> force;
      force[0] = normal;
      force[1] = shear[0];
      force[2] = shear[1];
      return force;
    }


    /**
     * Finds the force between two forces with these gaps at which gap(force) is
     * zero, and evaluates it there last. If both gaps have one sign, it takes
     * the force of the smaller one.
     */
    template <typename Gap>
    void
    close_gap(const Gap   &gap,
              const double x0,
              const double g0,
              const double x1,
              const double g1)
    {
      if (x0 == x1 || !(g0 * g1 < 0.))
        {
          gap(std::abs(g0) < std::abs(g1) ? x0 : x1);
          return;
        }
      const double size   = std::min(std::abs(g0), std::abs(g1));
      double       best_x = x1, best_g = g1;
      bool         best_is_last = false;
      const auto   remember     = [&](const double x) {
        const double g = gap(x);
        best_is_last   = std::abs(g) <= std::abs(best_g);
        if (best_is_last)
          {
            best_x = x;
            best_g = g;
          }
        return g;
      };
      const auto closed = [&](const double lower, const double upper) {
        return std::abs(best_g) <= 1e-15 * size ||
               boost::math::tools::eps_tolerance<double>()(lower, upper);
      };
      std::uintmax_t iterations = 100;
      if (x0 < x1)
        boost::math::tools::toms748_solve(
          remember, x0, x1, g0, g1, closed, iterations);
      else
        boost::math::tools::toms748_solve(
          remember, x1, x0, g1, g0, closed, iterations);
      if (!best_is_last)
        gap(best_x);
    }
  } // namespace


  double
  ContactLimits::shear(const bool open, const double force) const
  {
    if (locked)
      return std::numeric_limits<double>::max();
    return open ?
             bond :
             bond + without_pressure() + with_pressure() * std::max(force, 0.);
  }


  InterfaceHistory
  ContactPoint::history_since(const InterfaceHistory &before,
                              const bool              was_bonded,
                              const double            distance) const
  {
    InterfaceHistory result = before;
    result.tip              = history.tip;
    const bool open         = status == ContactStatus::open;
    if (open)
      result.opening = std::max(result.opening, gap[0]);
    if (!open || was_bonded)
      result.slip += distance;
    return result;
  }


  double
  ContactPoint::used_bond() const
  {
    double used =
      limits.tension > 0. ? std::max(0., -force[0] / limits.tension) : 0.;
    if (!limits.locked && limits.bond > 0.)
      used = std::max(used,
                      (std::hypot(force[1], force[2]) -
                       limits.shear(false, force[0]) + limits.bond) /
                        limits.bond);
    return used;
  }


  DelassusOperator::DelassusOperator(const Tensor<2, 3> &delassus)
    : full(delassus)
  {
    // a fixed direction has round-off
    for (unsigned int d = 0; d < 3; ++d)
      if (full[d][d] <= fixed * trace(full))
        for (unsigned int e = 0; e < 3; ++e)
          full[d][e] = full[e][d] = 0.;
    const SymmetricTensor<2, 3> symmetric = symmetrize(full);
    const auto                  system =
      eigenvectors(symmetric, SymmetricTensorEigenvectorMethod::jacobi);
    for (const auto &[value, vector] : system)
      if (value > fixed * system[0].first)
        inverse += outer_product(vector, vector) / value;

    const double mean       = 0.5 * (full[1][1] + full[2][2]),
                 difference = 0.5 * (full[1][1] - full[2][2]),
                 radius     = std::hypot(difference, full[1][2]);
    const double angle      = 0.5 * std::atan2(full[1][2], difference);
    tangential              = {{mean + radius, mean - radius}};
    if (tangential[1] < fixed * tangential[0])
      tangential[1] = 0.;
    axes[0][0] = axes[1][1] = std::cos(angle);
    axes[0][1]              = std::sin(angle);
    axes[1][0]              = -axes[0][1];
  }


  namespace
  {
    /** The contact of one point whose normal and tangential motions may be
     *  coupled; the states of contact are tried in turn. */
    class CoupledContact
    {
    public:
      CoupledContact(const Tensor<1, 3>     &b,
                     const DelassusOperator &delassus,
                     const ContactLimits    &limits)
        : b(b)
        , delassus(delassus)
        , limits(limits)
        , D(delassus.full)
        , lowest(limits.opening_force())
      {}

      /** Whether the force that removes all opening and slip is within the
       *  limits. */
      bool
      sticks()
      {
        F             = -(delassus.inverse * b);
        result.status = ContactStatus::sticking;
        return (b + D * F).norm() <= left_over * b.norm() && F[0] >= lowest &&
               std::hypot(F[1], F[2]) <= limits.shear(false, F[0]);
      }

      /** Finds the pressure that closes the point while it slips; returns
       *  whether there is one. */
      bool
      slides()
      {
        const auto closed_gap = [&](const double normal) {
          return gap(normal, limits.shear(false, normal));
        };
        if (D[0][0] == 0.)
          {
            if (b[0] <= 0.)
              closed_gap(0.);
            return b[0] <= 0.;
          }
        double below = lowest, gap_below = closed_gap(below);
        if (gap_below >= 0.)
          return false;
        // a bond may be much stronger than the force
        if (lowest < 0.)
          if (const double without = closed_gap(0.); without < 0.)
            {
              below     = 0.;
              gap_below = without;
            }

        const double start = below;
        double       above = start - gap_below / D[0][0],
               gap_above   = closed_gap(above);
        // where a singular Delassus operator lets the point stick, the gap is
        // zero
        for (unsigned int i = 0; i < 100 && gap_above < -round_off * b.norm();
             ++i)
          {
            below     = above;
            gap_below = gap_above;
            above += std::max(above - start, -gap_above / D[0][0]);
            gap_above = closed_gap(above);
          }
        close_gap(closed_gap, below, gap_below, above, gap_above);
        return true;
      }

      void
      open()
      {
        const double limit = limits.shear(true, 0.);
        if (D[0][0] == 0.) // no normal force has an effect
          gap(0., limit);
        else if (gap(lowest, limit) < 0. && !limits.locked)
          {
            close_with_cohesion();
            return;
          }
        else if (limits.opening > 0. && limits.tension > 0.) // an opened bond
          {
            const auto too_much = [&](const double normal) {
              return normal +
                     limits.tension *
                       std::min(gap(normal, limit) / limits.opening, 1.);
            };
            close_gap(too_much,
                      -limits.tension,
                      too_much(-limits.tension),
                      0.,
                      too_much(0.));
          }
        result.status = ContactStatus::open;
      }

      ContactForce result;

    private:
      /** Sets the shear force under this normal force; returns the gap. */
      double
      gap(const double normal, const double limit)
      {
        bool slips = false;
        F          = shear_force(b, delassus, normal, limit, slips);
        result.status =
          slips ? ContactStatus::sliding : ContactStatus::sticking;
        return b[0] + D[0] * F;
      }

      /** With its full cohesion the point would open, without cohesion it would
       *  not: it is closed without pressure, with the part of the cohesion that
       *  keeps it closed. */
      void
      close_with_cohesion()
      {
        const auto partial = [&](const double limit) {
          return gap(lowest, limit);
        };
        const double all = limits.bond + limits.without_pressure();
        close_gap(
          partial, limits.bond, partial(limits.bond), all, partial(all));
      }

      const Tensor<1, 3>     &b;
      const DelassusOperator &delassus;
      const ContactLimits    &limits;
      const Tensor<2, 3>     &D;
      const double            lowest; // normal force [N]
      Tensor<1, 3>           &F = result.force;
    };
  } // namespace


  ContactForce
  solve_contact(const Tensor<1, 3>     &b,
                const DelassusOperator &delassus,
                const ContactLimits    &limits)
  {
    CoupledContact contact(b, delassus, limits);
    if (!contact.sticks() && !contact.slides())
      contact.open();
    return contact.result;
  }


  ContactForce
  solve_contact(const Tensor<1, 3>  &b,
                const double         delassus,
                const ContactLimits &limits)
  {
    ContactForce result;
    bool         open  = false;
    result.force[0]    = normal_force(b[0], delassus, limits, open);
    result.status      = open ? ContactStatus::open : ContactStatus::sticking;
    const double limit = limits.shear(open, result.force[0]);
    if (limit == 0. || delassus == 0.)
      {
        if (!open && delassus > 0.)
          result.status = ContactStatus::sliding;
        return result;
      }
    const double slip = std::sqrt(b[1] * b[1] + b[2] * b[2]);
    double       size = 1. / delassus;
    if (slip > limit * delassus)
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
