#include <voussoir/constraints/contact_equations.h>
#include <voussoir/constraints/contact_homotopy.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Units are those of ContactEquations.

    // A residual this large is round-off.
    constexpr double round_off = 1e-12;

    // Compliances of a point as shares of its own Delassus operator, and limits
    // of strength in place of infinity; tried in turn.
    constexpr std::array<double, 4> softnesses{{1e-6, 1e-8, 1e-7, 1e-10}};
    constexpr std::array<double, 3> caps{
      {1e2, 1e4, std::numeric_limits<double>::infinity()}};

    constexpr unsigned int max_starts = 8, max_corrections = 10,
                           max_steps = 2000;

    constexpr double smallest_step = 1e-14;


    using namespace Dense;

    /** A path of solutions from t = 0 to t = 1. */
    class Homotopy : ContactEquations
    {
    public:
      Homotopy(const std::vector<double>        &delassus,
               const std::vector<Tensor<1, 3>>  &gaps,
               const std::vector<ContactLimits> &limits,
               const double                      round_off_of_gaps,
               const double                      cap,
               std::mt19937                     &generator)
        : ContactEquations(delassus, gaps, limits, round_off_of_gaps, cap)
        , generator(generator)
      {}

      ContactForces
      find()
      {
        ContactForces best{std::vector<ContactForce>(n / 3), 1.};
        if (points.empty()) // all nodes are fixed
          best.residual = 0.;
        for (unsigned int i = 0;
             i < (best.residual > unsolved_contact ? max_starts : 2) &&
             best.residual > round_off;
             ++i)
          {
            softness = softnesses[i % softnesses.size()];
            start();
            for (unsigned int j = 0; j < max_corrections; ++j)
              {
                // a homotopy that loses its path mostly does so near its end
                const bool arrived = follow();
                finish(best);
                if (!arrived || best.residual <= round_off)
                  break;
                correct_softness();
              }
          }
        return best;
      }

    private:
      /** The state at t = 0: all points are open by more than bonds can close.
       *  Random forces and gaps vanish along the homotopy, so that no two
       *  points reach the end of a piece at once. */
      void
      start()
      {
        const auto random = [&] { return generator() / 4294967296.; };
        Vector     pull(n);
        for (double &value : pull)
          value = random() - 0.5;
        shift.assign(n, 0.);
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
            shift[i] += delassus[i * n + j] * pull[j];
        widening.assign(n, 0.);
        bond_slope = 0.;
        x.assign(n + 1, 0.);
        for (unsigned int k = 0; k < points.size(); ++k)
          {
            ContactLawPoint &point = points[k];
            point.segment          = point.segments.size() - 1;
            point.slips            = !point.locked;
            x[3 * k]               = point.now().at;
          }
        double reach = 1.;
        for (const ContactLawPoint &point : points)
          reach += point.bond - point.now().force;
        // this is linear, and independent of t
        x          = sum(x, 1., linearize(x).nearest);
        x.back()   = 0.;
        widening   = shift;
        bond_slope = 1.;
        shift.assign(n, 0.);
        for (unsigned int k = 0; k < points.size(); ++k)
          {
            const ContactLawPoint &point = points[k];
            const double           open =
              point.now().at - point.stiffness * reach * (1. + random());
            widening[3 * k] += std::max(0., x[3 * k] - open) / point.stiffness;
            x[3 * k] = std::min(x[3 * k], open);
          }
      }

      /** Starts a homotopy at the solution of the last one, with gaps such that
       *  its own solution is free of the effect of the points' compliance. */
      void
      correct_softness()
      {
        shift      = softening(x);
        bond_slope = 0.;
        widening.assign(n, 0.);
        x.back() = 1.;
        widening = residual(x, true);
        x.back() = 0.;
      }

      /** Accuracy of unknowns that only the compliance of the points
       *  determines. */
      double
      tolerance(const Vector &x) const
      {
        return 1e-15 / softness * (1. + largest(x));
      }

      /** Newton's iteration to the nearest place of the path, or to the end of
       *  its piece; returns whether it is found. */
      bool
      approach(Vector &x, const End *end = nullptr) const
      {
        for (unsigned int i = 0; i < 12; ++i)
          {
            const Line line   = linearize(x);
            Vector     change = line.nearest;
            if (end)
              {
                Vector       gradient;
                const double way = way_to(*end, x, gradient);
                change           = sum(change,
                             -(way + product(gradient, change)) /
                               product(gradient, line.direction),
                             line.direction);
              }
            x = sum(x, 1., change);
            if (!std::isfinite(product(x, x)))
              return false;
            if (largest(change) <= tolerance(x))
              return true;
          }
        return false;
      }

      /** Whether the shear of every point nearly keeps its direction. */
      bool
      keeps_direction(const Vector &next) const
      {
        for (unsigned int k = 0; k < points.size(); ++k)
          if (points[k].slips && limit(k, next) != 0.)
            {
              const Tensor<1, 2> before({x[3 * k + 1], x[3 * k + 2]}),
                after({next[3 * k + 1], next[3 * k + 2]});
              if (!(before * after >= 0.7 * before.norm() * after.norm()))
                return false;
            }
        return true;
      }

      /** Takes a step along the path, or to the end of its piece if that comes
       *  first; returns whether the step was short enough to stay on the path.
       */
      bool
      advance(const Vector       &direction,
              const double        step,
              Vector             &next,
              std::optional<End> &reached) const
      {
        reached.reset();
        const double tolerated = tolerance(x);
        const Vector predicted = sum(x, step, direction);
        next                   = predicted;
        if (!approach(next) ||
            distance(next, predicted) > 0.1 * step + tolerated ||
            !keeps_direction(next))
          return false;

        const auto all   = ends();
        const End *first = nullptr;
        for (std::size_t i = 0; i < all.size(); ++i)
          {
            const End *nearer = nullptr;
            double     part   = 1.;
            for (const End &end : all)
              {
                const double after = way_to(end, next);
                Vector       gradient;
                const double before = way_to(end, x, gradient);
                if (&end == first || after >= (first ? -tolerated : 0.))
                  continue;
                // a piece that has just begun
                if (before < tolerated && product(gradient, direction) > 0.)
                  {
                    if (after < -tolerated)
                      return false;
                    continue;
                  }
                if (const double fraction =
                      std::max(before, 0.) / (std::max(before, 0.) - after);
                    !nearer || fraction < part)
                  {
                    nearer = &end;
                    part   = fraction;
                  }
              }
            if (!nearer)
              break;
            const Vector between = sum(x, part, sum(next, -1., x));
            first                = nearer;
            next                 = between;
            if (!approach(next, first) ||
                distance(next, between) >
                  0.1 * distance(x, between) + 100. * tolerated)
              return false;
          }
        if (first)
          reached = *first;
        return true;
      }

      /** Follows the path from t = 0 to t = 1; returns whether it arrives.
       */
      bool
      follow()
      {
        double orientation = 0., step = 0.1;
        for (unsigned int i = 0; i < max_steps; ++i)
          {
            Vector direction = linearize(x).direction;
            if (orientation == 0.)
              orientation = direction.back() > 0. ? 1. : -1.;
            for (double &value : direction)
              value *= orientation;
            if (!std::isfinite(product(direction, direction)) || x.back() < -1.)
              return false;

            Vector             next;
            std::optional<End> reached;
            while (!advance(direction, step, next, reached))
              if ((step *= 0.25) < smallest_step)
                return false;
            x = next;
            if (!reached)
              step *= 2.;
            else if (reached->kind == End::time)
              return true;
            else
              cross(*reached);
          }
        return false;
      }

      void
      cross(const End &end)
      {
        ContactLawPoint &point = points[end.point];
        if (end.kind == End::opening)
          ++point.segment;
        else if (end.kind == End::closing)
          --point.segment;
        else
          point.slips = !point.slips;
      }

      /** Newton's iteration from the end of a path, on the pieces where the
       *  points are, until the effects of compliance and round-off of the path
       *  are removed. */
      void
      finish(ContactForces &best)
      {
        const auto   points_there = points;
        const Vector there        = x;
        x.back()                  = 1.;
        bond_slope                = 0.;
        widening.assign(n, 0.);
        for (unsigned int i = 0; i < max_corrections; ++i)
          {
            for (unsigned int k = 0; k < points.size(); ++k)
              {
                ContactLawPoint &point = points[k];
                point.segment          = 0;
                while (x[3 * k] < point.now().from)
                  ++point.segment;
                point.slips =
                  !point.locked &&
                  std::hypot(x[3 * k + 1], x[3 * k + 2]) > limit(k, x);
              }
            keep_better(best);
            if (best.residual <= round_off)
              return;
            shift = softening(x);
            x     = sum(x, 1., linearize(x).nearest);
            if (!std::isfinite(product(x, x)))
              break;
          }
        points = points_there;
        x      = there;
      }

      void
      keep_better(ContactForces &best) const
      {
        const double size = largest(residual(x, false));
        if (!(size < best.residual) ||
            std::any_of(points.begin(),
                        points.end(),
                        [](const ContactLawPoint &point) {
                          return point.at_cap();
                        }))
          return;
        best.residual = size;
        for (unsigned int k = 0; k < points.size(); ++k)
          best.points[k] = {force_unit * state(k, x).force, points[k].status()};
      }

      Vector        x;
      std::mt19937 &generator;
    };
  } // namespace


  ContactForces
  solve_contact(const std::vector<double>        &delassus,
                const std::vector<Tensor<1, 3>>  &gaps,
                const std::vector<ContactLimits> &limits,
                const double                      round_off)
  {
    ContactForces best{{}, std::numeric_limits<double>::infinity()};
    // the same random numbers for each cluster, but different ones for each
    // limit of strength, most of which are not reached
    std::mt19937 generator;
    for (const double cap : caps)
      if (best.residual > unsolved_contact)
        if (auto found =
              Homotopy(delassus, gaps, limits, round_off, cap, generator)
                .find();
            found.residual < best.residual)
          best = std::move(found);
    return best;
  }
} // namespace Voussoir
