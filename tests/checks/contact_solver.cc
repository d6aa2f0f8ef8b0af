// The solver of contact clusters by itself, on clusters made by hand.

#include <voussoir/constraints/contact_solver.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <random>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    class Strength : public InterfaceLaw
    {
    public:
      explicit Strength(const InterfaceStrength &given)
        : given(given)
      {}

      void
      declare_parameters(ParameterHandler &) override
      {}

      InterfaceStrength
      strength(const InterfaceHistory &) const override
      {
        return given;
      }

      InterfaceStrength given;
    };


    Tensor<2, 3>
    frame_of(Tensor<1, 3> n)
    {
      n /= n.norm();
      Tensor<1, 3> t1;
      t1[std::abs(n[2]) < 0.9 ? 2 : 0] = 1.;
      t1                               = cross_product_3d(t1, n);
      t1 /= t1.norm();
      const Tensor<1, 3> t2 = cross_product_3d(n, t1);
      Tensor<2, 3>       frame;
      frame[0] = n;
      frame[1] = t1;
      frame[2] = t2;
      return frame;
    }


    /** Clusters of random shape, masses, strengths and predicted motion. */
    class Random
    {
    public:
      double
      number(const double low, const double high)
      {
        // the standard's distributions differ between libraries
        return low + (high - low) * generator() / 4294967296.;
      }

      Tensor<1, 3>
      vector()
      {
        Tensor<1, 3> v;
        for (unsigned int d = 0; d < 3; ++d)
          v[d] = number(-1., 1.);
        return v;
      }

      /** Inverse of a mass with added mass of a few facets. */
      Tensor<2, 3>
      inverse_mass(const double anisotropy)
      {
        Tensor<2, 3> mass =
          number(0.5, 2.) * Tensor<2, 3>(unit_symmetric_tensor<3>());
        if (anisotropy > 0.)
          for (unsigned int facet = 0; facet < 2; ++facet)
            {
              const Tensor<1, 3> n = vector();
              mass += anisotropy * outer_product(n, n);
            }
        return anisotropy > 0. ?
                 invert(mass) :
                 1. / mass[0][0] * Tensor<2, 3>(unit_symmetric_tensor<3>());
      }

      std::vector<ContactPoint>
      cluster(const unsigned int n_nodes, const unsigned int n_points)
      {
        std::vector<ContactPoint> points(n_points);
        for (unsigned int k = 0; k < n_points; ++k)
          {
            // a chain first, so that all nodes are in it
            points[k].first  = k < n_nodes - 1 ? k : generator() % n_nodes;
            points[k].second = k < n_nodes - 1 ? k + 1 : generator() % n_nodes;
            if (points[k].first == points[k].second)
              points[k].second = (points[k].first + 1) % n_nodes;
            points[k].frame = frame_of(vector());
            points[k].area  = number(0.5, 2.);
          }
        return points;
      }

      std::vector<Tensor<1, 3>>
      motion(const unsigned int n_nodes)
      {
        std::vector<Tensor<1, 3>> u(n_nodes);
        for (auto &x : u)
          x = vector();
        return u;
      }

    private:
      std::mt19937 generator;
    };


    /** Distance of a solution from the law of contact, over the size of the
     *  predicted motion or of the forces. */
    double
    violation(const ContactPoints             &contact,
              const std::vector<Tensor<1, 3>> &displacement)
    {
      double largest = 0., force_size = 1e-300;
      for (const ContactPoint &point : contact.points)
        keep_largest(force_size, point.force.norm());
      for (const ContactPoint &point : contact.points)
        {
          const InterfaceStrength s =
            contact.surfaces[point.surface].law->strength(point.history);
          Tensor<1, 3> g = point.frame * (displacement[point.second] -
                                          displacement[point.first]);
          g += point.initial_gap;
          const Tensor<1, 3> &F     = point.force;
          const double        shear = std::hypot(F[1], F[2]);
          const auto          worse = [&](const double value) {
            keep_largest(largest, std::abs(value));
          };
          if (point.status == ContactStatus::open)
            {
              worse(positive_part(-g[0]));
              worse((F[0] + s.tension * point.area) / force_size);
              // strength of a bond without a largest opening
              worse(positive_part(shear - s.bond * point.area) / force_size);
              continue;
            }
          worse(g[0]);
          worse(positive_part(-F[0] - s.tension * point.area) / force_size);
          const double limit = (s.cohesion + s.bond) * point.area +
                               s.friction * std::max(F[0], 0.);
          if (point.status == ContactStatus::sticking)
            {
              worse(std::hypot(g[1], g[2]));
              worse(std::max(shear - limit, 0.) / force_size);
            }
          else
            {
              const double slip = std::hypot(g[1], g[2]);
              if (F[0] > 1e-12 * force_size)
                worse((shear - limit) / force_size);
              worse(std::max(shear - limit, 0.) / force_size);
              // against the slip
              worse((F[1] * g[1] + F[2] * g[2] + shear * slip) / force_size);
            }
        }
      return largest;
    }


    struct Made
    {
      ContactPoints             contact;
      ContactSolver             solver;
      std::vector<Tensor<2, 3>> inverse_mass;
      std::vector<Tensor<1, 3>> displacement, predicted, force;
      ContactSolver::Effort     effort;
    };


    Made
    make(Random            &random,
         const Strength    &law,
         const unsigned int n_nodes,
         const unsigned int n_points,
         const double       anisotropy)
    {
      ContactSurface surface;
      surface.law = &law;
      Made made{ContactPoints({surface}), {}, {}, {}, {}, {}, {}};
      made.contact.add_cluster(n_nodes, random.cluster(n_nodes, n_points));
      for (unsigned int i = 0; i < n_nodes; ++i)
        made.inverse_mass.push_back(random.inverse_mass(anisotropy));
      made.solver.prepare_step(made.contact, made.inverse_mass, 1.);
      made.predicted = made.displacement = random.motion(n_nodes);
      made.force.resize(n_nodes);
      made.effort =
        made.solver.solve(made.contact, made.displacement, made.force);
      return made;
    }


    /** Finds which points are closed, by trying all choices with dense systems.
     */
    class WithoutFriction
    {
    public:
      explicit WithoutFriction(const Made &made)
        : n(made.contact.points.size())
        , delassus(n * n)
        , gap(n)
      {
        const auto &points = made.contact.points;
        for (unsigned int k = 0; k < n; ++k)
          {
            gap[k] = points[k].frame[0] * (made.predicted[points[k].second] -
                                           made.predicted[points[k].first]);
            for (unsigned int l = 0; l < n; ++l)
              for (unsigned int node = 0; node < made.predicted.size(); ++node)
                delassus[k * n + l] +=
                  sign(points[k], node) * sign(points[l], node) *
                  (points[k].frame[0] *
                   (made.inverse_mass[node] * points[l].frame[0]));
          }
      }

      /** The forces. */
      std::vector<double>
      solve() const
      {
        for (unsigned int choice = 0; choice < (1u << n); ++choice)
          {
            std::vector<unsigned int> closed;
            for (unsigned int k = 0; k < n; ++k)
              if (choice & (1u << k))
                closed.push_back(k);
            std::vector<double> forces(n, 0.);
            if (!closed.empty())
              {
                FullMatrix<double> matrix(closed.size(), closed.size());
                Vector             right(closed.size()), x(closed.size());
                for (unsigned int i = 0; i < closed.size(); ++i)
                  {
                    right[i] = -gap[closed[i]];
                    for (unsigned int j = 0; j < closed.size(); ++j)
                      matrix(i, j) = delassus[closed[i] * n + closed[j]];
                  }
                matrix.gauss_jordan();
                matrix.vmult(x, right);
                for (unsigned int i = 0; i < closed.size(); ++i)
                  forces[closed[i]] = x[i];
              }
            bool good = true;
            for (unsigned int k = 0; k < n; ++k)
              {
                double g = gap[k];
                for (unsigned int l = 0; l < n; ++l)
                  g += delassus[k * n + l] * forces[l];
                good = good && forces[k] >= -1e-13 && g >= -1e-13;
              }
            if (good)
              return forces;
          }
        return {};
      }

    private:
      using Vector = dealii::Vector<double>;

      static double
      sign(const ContactPoint &point, const unsigned int node)
      {
        return node == point.second ? 1. : node == point.first ? -1. : 0.;
      }

      const unsigned int  n;
      std::vector<double> delassus, gap;
    };


    class ContactSolverCheck : public Check
    {
    public:
      void
      run(const ParameterFile &, Verdicts &verdicts, const MPI_Comm) override
      {
        without_friction(verdicts);
        with_friction(verdicts);
        between_fixed_nodes(verdicts);
        blocks_on_a_base(verdicts);
        friction_that_fades(verdicts);
        fixed_along_the_normal(verdicts);
      }

    private:
      static void
      without_friction(Verdicts &verdicts)
      {
        Random         random;
        const Strength smooth({0., 0., 0., 0.});
        double         difference = 0., residual = 0.;
        unsigned int   closed = 0;
        // trees and rings of points whose constraints are linearly independent
        for (unsigned int trial = 0; trial < 200; ++trial)
          {
            const unsigned int n_nodes = 2 + trial % 7;
            const Made         made =
              make(random, smooth, n_nodes, n_nodes - 1 + trial % 3, 2.);
            const auto exact = WithoutFriction(made).solve();
            double     size  = 1e-300;
            for (const double force : exact)
              keep_largest(size, force);
            for (unsigned int k = 0; k < exact.size(); ++k)
              {
                keep_largest(difference,
                             std::abs(made.contact.points[k].force[0] -
                                      exact[k]) /
                               std::max(size, 1.));
                closed += exact[k] > 0. ? 1 : 0;
              }
            keep_largest(residual, made.effort.residual);
          }
        verdicts.above("without friction: closed points", closed, 200.);
        verdicts.below("forces against dense systems", difference, 1e-8);
        verdicts.below("residual", residual, 1e-8);
      }

      static void
      with_friction(Verdicts &verdicts)
      {
        for (const double anisotropy : {0., 2.})
          {
            Random       random;
            double       worst    = 0.;
            unsigned int unsolved = 0;
            unsigned int number[3]{0, 0, 0};
            for (unsigned int trial = 0; trial < 400; ++trial)
              {
                const Strength law(
                  {trial % 4 == 0 ? 0.1 : 0.,
                   trial % 4 == 0 ? 0.2 : 0.,
                   // cohesion that ends at opening is a discontinuity, and with
                   // coupling there may be no solution
                   trial % 3 == 0 && anisotropy == 0. ? 0.1 : 0.,
                   0.2 * (trial % 5)});
                const unsigned int n_nodes = 2 + trial % 4;
                const Made         made =
                  make(random, law, n_nodes, n_nodes - 1, anisotropy);
                keep_largest(worst, violation(made.contact, made.displacement));
                unsolved += made.effort.unsolved;
                for (const auto &point : made.contact.points)
                  ++number[static_cast<unsigned int>(point.status)];
              }
            const std::string masses =
              anisotropy > 0. ? "added mass: " : "plain masses: ";
            verdicts.above(masses + "open points", number[0], 100.);
            verdicts.above(masses + "sliding points", number[1], 100.);
            verdicts.above(masses + "sticking points", number[2], 40.);
            verdicts.below(masses + "violation of the law", worst, 1e-8);
            verdicts.below(masses + "unsolved clusters", unsolved, 0.);
          }
      }

      /** A node on two or three planes of fixed nodes, which is constrained by
       *  more points than it has degrees of freedom: from sliding along a line
       *  to forces that are not unique. */
      static void
      between_fixed_nodes(Verdicts &verdicts)
      {
        Random random;
        Worst  worst;
        for (unsigned int trial = 0; trial < 3000; ++trial)
          {
            const Strength            law({0.,
                                           0.,
                                trial % 4 == 0 ? random.number(0., 0.1) : 0.,
                                           random.number(0., 1.2)});
            const unsigned int        n_planes = 2 + trial % 2;
            std::vector<ContactPoint> points(n_planes);
            for (unsigned int k = 0; k < n_planes; ++k)
              {
                Tensor<1, 3> n   = random.vector();
                n[2]             = std::abs(n[2]) + 0.2;
                points[k].first  = k;
                points[k].second = n_planes;
                points[k].frame  = frame_of(n);
                points[k].area   = random.number(0.5, 2.);
              }
            Made made = empty(law);
            made.contact.add_cluster(n_planes + 1, points);
            made.inverse_mass.resize(n_planes + 1);
            made.inverse_mass[n_planes] =
              random.inverse_mass(trial % 3 == 0 ? 2. : 0.);
            worst.add(random, made);
          }
        worst.report("between fixed nodes: ", verdicts);
      }

      /** Four blocks with upright joints on four parts of a base. */
      static void
      blocks_on_a_base(Verdicts &verdicts)
      {
        Random random;
        Worst  worst;
        for (unsigned int trial = 0; trial < 500; ++trial)
          {
            const Strength            law({0., 0., 0., 0.3 * (trial % 4)});
            std::vector<ContactPoint> points;
            const auto                add = [&](const unsigned int  first,
                                 const unsigned int  second,
                                 const Tensor<1, 3> &normal) {
              ContactPoint point;
              point.first  = first;
              point.second = second;
              point.frame  = frame_of(normal);
              point.area   = random.number(0.5, 2.);
              points.push_back(point);
            };
            for (unsigned int i = 0; i < 4; ++i)
              {
                add(4 + i, i, Tensor<1, 3>({0., 0., 1.}));
                const double angle = numbers::PI_2 * i;
                for (const unsigned int part : {0, 4})
                  if (part == 0 || trial % 2 == 0) // a base in one part or four
                    add(part + i,
                        part + (i + 1) % 4,
                        Tensor<1, 3>({std::cos(angle), std::sin(angle), 0.}));
              }
            Made made = empty(law);
            made.contact.add_cluster(8, points);
            for (unsigned int i = 0; i < 8; ++i)
              made.inverse_mass.push_back(random.inverse_mass(0.));
            worst.add(random, made);
          }
        worst.report("blocks on a base: ", verdicts);
      }

      /** Friction that follows the pressure is nearly zero long after a point
       *  has opened. */
      static void
      friction_that_fades(Verdicts &verdicts)
      {
        Random                 random;
        const DelassusOperator delassus(random.inverse_mass(2.));
        double                 shear = 0., closed = 0.;
        for (const double lasting : {1e-20, 1e-200, 1e-310, 5e-324})
          for (const double gap : {0.2, -0.2})
            {
              ContactLimits limits;
              limits.friction = limits.at_once = gap > 0. ? 0.5 : 0.;
              limits.lasting                   = lasting;
              const Tensor<1, 3> b({gap, -7e-5, 5e-4});
              const ContactForce found = solve_contact(b, delassus, limits);
              keep_largest(shear, std::hypot(found.force[1], found.force[2]));
              keep_largest(closed,
                           gap > 0. ?
                             found.force.norm() :
                             std::abs((b + delassus.full * found.force)[0]));
            }
        verdicts.below("friction that fades: shear", shear, 1e-15);
        verdicts.below("friction that fades: gap, or force where open",
                       closed,
                       1e-15);
      }

      /** The compliance across an interface whose nodes are fixed along its
       *  normal, and the motion of these, are round-off. */
      static void
      fixed_along_the_normal(Verdicts &verdicts)
      {
        Random random;
        double normal = 0., shear = 0.;
        for (unsigned int trial = 0; trial < 200; ++trial)
          {
            const Tensor<2, 3> frame = frame_of(random.vector());
            Tensor<2, 3>       inverse_mass(unit_symmetric_tensor<3>());
            inverse_mass -= outer_product(frame[0], frame[0]);
            Tensor<1, 3> b = frame * (inverse_mass * random.vector());
            b[0]           = trial % 2 == 0 ? 1e-17 : -1e-17;
            ContactLimits limits;
            limits.friction = 1.;
            limits.tension  = trial % 4 < 2 ? 0. : 1.;
            limits.bond     = 0.2;
            const ContactForce found =
              solve_contact(b,
                            DelassusOperator(frame * inverse_mass *
                                             transpose(frame)),
                            limits);
            keep_largest(normal, std::abs(found.force[0]));
            const double slip = std::hypot(b[1], b[2]);
            keep_largest(shear,
                         std::abs(std::hypot(found.force[1], found.force[2]) -
                                  std::min(slip, 0.2)));
          }
        verdicts.below("fixed along the normal: normal force", normal, 1e-15);
        verdicts.below("fixed along the normal: shear", shear, 1e-12);
      }

      static Made
      empty(const Strength &law)
      {
        ContactSurface surface;
        surface.law = &law;
        return {ContactPoints({surface}), {}, {}, {}, {}, {}, {}};
      }

      static double
      largest_force(const ContactPoints &contact)
      {
        double largest = 0.;
        for (const ContactPoint &point : contact.points)
          keep_largest(largest, point.force.norm());
        return largest;
      }

      static bool
      same_motion(const Made &a, const Made &b)
      {
        double difference = 0.;
        for (unsigned int i = 0; i < a.displacement.size(); ++i)
          keep_largest(difference,
                       (a.displacement[i] - b.displacement[i]).norm());
        return difference < 1e-9;
      }

      /** Largest errors over several steps of many clusters. Each step is also
       *  solved from forces a thousand times as large. Friction may then
       *  prevent a slip that it does not prevent otherwise; but where the
       *  motion is the same, the forces must not depend on their start. */
      struct Worst
      {
        double       penetration = 0., run_away = 0.;
        unsigned int unsolved = 0, number[3]{0, 0, 0};

        void
        add(Random &random, Made &made)
        {
          const unsigned int n_nodes = made.inverse_mass.size();
          made.solver.prepare_step(made.contact, made.inverse_mass, 1.);
          made.force.resize(n_nodes);
          made.displacement.resize(n_nodes);
          for (unsigned int step = 0; step < 4; ++step)
            {
              const auto move = random.motion(n_nodes);
              for (unsigned int i = 0; i < n_nodes; ++i)
                if (made.inverse_mass[i].norm() > 0.)
                  made.displacement[i] += move[i];
              Made other = made;
              for (ContactPoint &point : other.contact.points)
                point.force *= 1000.;
              made.effort =
                made.solver.solve(made.contact, made.displacement, made.force);
              other.solver.solve(other.contact,
                                 other.displacement,
                                 other.force);
              if (largest_force(made.contact) > 0. && same_motion(made, other))
                keep_largest(run_away,
                             largest_force(other.contact) /
                               largest_force(made.contact));
              keep_largest(penetration, made.effort.penetration);
              unsolved += made.effort.unsolved;
              for (const auto &point : made.contact.points)
                ++number[static_cast<unsigned int>(point.status)];
            }
        }

        void
        report(const std::string &what, Verdicts &verdicts) const
        {
          verdicts.is_true(what + "many points open, slide and stick",
                           std::min({number[0], number[1], number[2]}) > 100);
          verdicts.below(what + "penetration over motion", penetration, 1e-12);
          verdicts.below(what + "unsolved clusters", unsolved, 0.);
          verdicts.below(what +
                           "forces from a start that ran away, over others",
                         run_away,
                         10.);
        }
      };
    };

    // Reference: other program
    const Registry<Check>::Add<ContactSolverCheck>
      registered("contact solver", "Contact clusters against dense systems.");
  } // namespace
} // namespace Voussoir
