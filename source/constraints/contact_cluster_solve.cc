// The contact of clusters of several points.

#include <voussoir/constraints/contact_homotopy.h>
#include <voussoir/constraints/contact_solver.h>

#include <deal.II/lac/exceptions.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Forces have converged when they change by less than the first share, or
    // move their points by less than the second share of the displacement.
    constexpr double accuracy = 1e-12, round_off = 1e-13;

    // Sweeps before another method is tried.
    constexpr unsigned int max_sweeps = 100;

    // Forces diverge if they would move a point more than this many times the
    // widest gap, or the motion by a force of the step before: the nodes are
    // jammed.
    constexpr double too_large = 1e4;

    // Compliance of a point in Newton's iteration, as a share of its own
    // Delassus operator: forces stay finite where contact constraints are
    // linearly dependent.
    constexpr double softness = 1e-3;

    constexpr unsigned int max_newton_steps = 10;

    // Number of sweeps after which Newton's iteration is tried, which is faster
    // where the sweeps converge slowly.
    constexpr unsigned int sweeps_per_jump = 5;
  } // namespace


  // The pseudo-inverse of the Delassus operator of all points together. It is
  // singular where nodes are fixed and where points form a ring; of the forces
  // with the same effect, those with the most even stresses are taken (weights
  // by area).
  void
  ContactSolver::make_matrices(const Points &points, Cluster &cluster) const
  {
    const unsigned int       n = 3 * cluster.n_points;
    LAPACKFullMatrix<double> matrix(n);
    std::vector<double>      weight(n);
    cluster.delassus.resize(n * n);
    double trace = 0.;
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      for (unsigned int l = 0; l < cluster.n_points; ++l)
        {
          const auto  &a = points[cluster.first_point + k];
          const auto  &b = points[cluster.first_point + l];
          Tensor<2, 3> block;
          for (const unsigned int node : {a.first, a.second})
            if (node == b.first || node == b.second)
              block += ((node == a.first) == (node == b.first) ? 1. : -1.) *
                       node_matrix[node];
          block = a.frame * block * transpose(b.frame);
          for (unsigned int d = 0; d < 3; ++d)
            for (unsigned int e = 0; e < 3; ++e)
              {
                cluster.delassus[(3 * k + d) * n + 3 * l + e] = block[d][e];
                matrix(3 * k + d, 3 * l + e) =
                  std::sqrt(a.area * b.area) * block[d][e];
                if (k == l && d == e)
                  {
                    weight[3 * k + d] = std::sqrt(a.area);
                    trace += a.area * block[d][d];
                  }
              }
        }
    cluster.stiffness.assign(n * n, 0.);
    if (trace == 0.)
      return;
    matrix /= trace / n;
    matrix.compute_inverse_svd(1e-11);
    for (unsigned int i = 0; i < n; ++i)
      if (matrix.singular_value(i) == 0.) // of the kernel
        {
          cluster.self_equilibrated.emplace_back(n);
          for (unsigned int j = 0; j < n; ++j)
            cluster.self_equilibrated.back()[j] = matrix.get_svd_vt()(i, j);
        }
    Vector<double> unit(n), column(n);
    for (unsigned int j = 0; j < n; ++j)
      {
        unit    = 0.;
        unit[j] = 1.;
        matrix.vmult(column, unit);
        for (unsigned int i = 0; i < n; ++i)
          cluster.stiffness[i * n + j] =
            weight[i] * column[i] * weight[j] * n / trace;
      }
  }


  void
  ContactSolver::solve_cluster(Points                          &points,
                               const Cluster                   &cluster,
                               const std::vector<Tensor<1, 3>> &displacement,
                               Effort                          &effort)
  {
    if (find_gaps(points, cluster, displacement) && hold_all(points, cluster))
      return;

    double size = 0., widest = 0., softest = 0.;
    for (unsigned int i = 0; i < cluster.n_nodes; ++i)
      size = std::max(size, displacement[cluster.first_node + i].norm());
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      if (points[cluster.first_point + k].joined)
        widest = std::max(widest, gaps[k].norm());
    for (unsigned int i = 0; i < 3 * cluster.n_points; ++i)
      softest =
        std::max(softest, cluster.delassus[i * (3 * cluster.n_points + 1)]);
    Sweep      last;
    const auto found = [&] {
      return last.change <= accuracy * last.largest ||
             last.moved <= round_off * size;
    };
    const auto run_away = [&] {
      return softest * last.largest > too_large * widest;
    };

    // the forces of the step before, from which the search starts, may be much
    // larger than those of this step, and their motions have round-off
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      {
        const double by_itself =
          softest * points[cluster.first_point + k].force.norm();
        size   = std::max(size, by_itself);
        widest = std::max(widest, by_itself);
      }
    find_moves(points, cluster);
    unsigned int n_sweeps = 0;
    for (; n_sweeps < max_sweeps && !found() && !run_away(); ++n_sweeps)
      last = n_sweeps % sweeps_per_jump == sweeps_per_jump - 1 ?
               sweep_after_jump(points, cluster, last) :
               sweep(points, cluster);
    effort.sweeps = std::max(effort.sweeps, n_sweeps);
    effort.all_sweeps += n_sweeps;
    ++effort.clusters;
    if (!found() || run_away())
      follow_path(points, cluster, size, effort);
    else if (last.largest > 0.)
      effort.residual = std::max(effort.residual, last.change / last.largest);
    if (!cluster.self_equilibrated.empty())
      remove_self_equilibrated(points, cluster, 100. * round_off * size);
  }


  void
  ContactSolver::follow_path(Points        &points,
                             const Cluster &cluster,
                             const double   size,
                             Effort        &effort)
  {
    std::vector<unsigned int>  joined;
    std::vector<Tensor<1, 3>>  gaps_to_close;
    std::vector<ContactLimits> limits;
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      if (points[cluster.first_point + k].joined)
        {
          joined.push_back(k);
          gaps_to_close.push_back(gaps[k]);
          limits.push_back(points[cluster.first_point + k].limits);
        }
    std::vector<double> delassus;
    for (const unsigned int k : joined)
      for (unsigned int d = 0; d < 3; ++d)
        for (const unsigned int l : joined)
          for (unsigned int e = 0; e < 3; ++e)
            delassus.push_back(
              cluster.delassus[(3 * k + d) * 3 * cluster.n_points + 3 * l + e]);
    const ContactForces found =
      solve_contact(delassus,
                    gaps_to_close,
                    limits,
                    10. * round_off * size); // of several sweeps
    ++effort.paths;
    effort.residual = std::max(effort.residual, found.residual);
    if (found.residual > unsolved_contact)
      ++effort.unsolved;
    if (found.residual == 1.) // the forces of the sweeps are the best known
      return;
    for (unsigned int i = 0; i < joined.size(); ++i)
      {
        ContactPoint &point = points[cluster.first_point + joined[i]];
        point.force         = found.points[i].force;
        point.status        = found.points[i].status;
      }
  }


  bool
  ContactSolver::find_gaps(const Points                    &points,
                           const Cluster                   &cluster,
                           const std::vector<Tensor<1, 3>> &displacement)
  {
    bool stick = true, given = false;
    std::fill_n(moves.begin(), cluster.n_nodes, Tensor<1, 3>());
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      {
        const ContactPoint &point = points[cluster.first_point + k];
        gaps[k] =
          gap_to_hold(point,
                      displacement[point.second] - displacement[point.first]);
        stick = stick && point.status == ContactStatus::sticking;
        if (point.given_force != 0.)
          {
            given = true;
            Tensor<1, 3> force;
            force[0] = point.given_force;
            add_to_moves(cluster, point, force);
          }
      }
    if (given)
      for (unsigned int k = 0; k < cluster.n_points; ++k)
        gaps[k] += relative_move(cluster, points[cluster.first_point + k]);
    return stick;
  }


  bool
  ContactSolver::hold_all(Points &points, const Cluster &cluster)
  {
    const unsigned int n = 3 * cluster.n_points;
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      {
        Tensor<1, 3> force;
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double *row = &cluster.stiffness[(3 * k + d) * n];
            for (unsigned int l = 0; l < cluster.n_points; ++l)
              for (unsigned int e = 0; e < 3; ++e)
                force[d] -= row[3 * l + e] * gaps[l][e];
          }
        const ContactLimits &limits = points[cluster.first_point + k].limits;
        if (force[0] < limits.opening_force() ||
            tangential_norm(force) > limits.shear(false, force[0]))
          return false;
        candidates[k].force = force;
      }
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      points[cluster.first_point + k].force = candidates[k].force;
    return true;
  }


  void
  ContactSolver::add_to_moves(const Cluster      &cluster,
                              const ContactPoint &point,
                              const Tensor<1, 3> &force)
  {
    const Tensor<1, 3> global = force * point.frame;
    moves[point.second - cluster.first_node] += motion(point.second, global);
    moves[point.first - cluster.first_node] -= motion(point.first, global);
  }


  Tensor<1, 3>
  ContactSolver::relative_move(const Cluster      &cluster,
                               const ContactPoint &point) const
  {
    return point.frame * (moves[point.second - cluster.first_node] -
                          moves[point.first - cluster.first_node]);
  }


  void
  ContactSolver::find_moves(const Points &points, const Cluster &cluster)
  {
    std::fill_n(moves.begin(), cluster.n_nodes, Tensor<1, 3>());
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      add_to_moves(cluster,
                   points[cluster.first_point + k],
                   points[cluster.first_point + k].force);
  }


  ContactSolver::Sweep
  ContactSolver::sweep(Points &points, const Cluster &cluster)
  {
    Sweep  result{0., 0., 0.};
    double sum = 0.;
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      {
        const unsigned int number = cluster.first_point + k;
        ContactPoint      &point  = points[number];
        const Tensor<1, 3> before = point.force;
        solve_point(point,
                    number,
                    gaps[k] + relative_move(cluster, point) -
                      relative_motion(number, before));
        const Tensor<1, 3> change = point.force - before;
        add_to_moves(cluster, point, change);
        const double size = change.norm();
        result.change     = std::max(result.change, size);
        result.moved =
          std::max(result.moved, relative_motion(number, change).norm());
        result.largest = std::max(result.largest, point.force.norm());
        sum += size;
      }
    if (!std::isfinite(sum)) // std::max drops NaN
      result.change = result.moved = result.largest =
        std::numeric_limits<double>::infinity();
    return result;
  }


  ContactSolver::Sweep
  ContactSolver::sweep_after_jump(Points        &points,
                                  const Cluster &cluster,
                                  const Sweep   &before)
  {
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      {
        const ContactPoint &point = points[cluster.first_point + k];
        candidates[k]             = {point.force, point.status};
      }
    iterate_newton(points, cluster, before.largest);
    find_moves(points, cluster);
    const Sweep result = sweep(points, cluster);
    if (result.change <= before.change)
      return result;
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      {
        ContactPoint &point = points[cluster.first_point + k];
        point.force         = candidates[k].force;
        point.status        = candidates[k].status;
      }
    find_moves(points, cluster);
    return before;
  }


  void
  ContactSolver::iterate_newton(Points        &points,
                                const Cluster &cluster,
                                const double   largest_force)
  {
    for (unsigned int i = 0; i < max_newton_steps; ++i)
      if (newton_step(points, cluster) <= accuracy * largest_force)
        return;
  }


  namespace
  {
    /** A point k in Newton's iteration, with its three rows of the linear
     *  system for the changes of the forces. */
    struct NewtonPoint
    {
      const unsigned int        k;
      const ContactPoint       &point;
      const double             *W; // rows of the Delassus operator
      const Tensor<1, 3>        gap;
      const double              r; // stiffness
      LAPACKFullMatrix<double> &system;
      Vector<double>           &right;

      const ContactLimits &limits = point.limits;
      const Tensor<1, 3>  &F      = point.force;
      const Tensor<1, 3>   trial  = F - r * gap;
      const bool           open   = trial[0] < limits.opening_force();

      void
      set_normal_row() const
      {
        const unsigned int n = system.n(), row = 3 * k;
        if (!open)
          {
            for (unsigned int j = 0; j < n; ++j)
              system(row, j) = r * W[j];
            system(row, row) += softness;
            right[row] = -r * gap[0];
          }
        else if (limits.opening > 0. && limits.tension > 0. &&
                 gap[0] < limits.opening)
          {
            // a bond unloads towards zero opening
            const double secant = limits.tension / limits.opening;
            for (unsigned int j = 0; j < n; ++j)
              system(row, j) += secant * W[j];
            right[row] = -secant * gap[0] - F[0];
          }
        else
          right[row] = -limits.tension - F[0];
      }

      void
      set_tangential_rows() const
      {
        const unsigned int n     = system.n();
        const double       limit = limits.shear(open, F[0]);
        const double       size =
          std::sqrt(trial[1] * trial[1] + trial[2] * trial[2]);
        const bool   slides = size > limit;
        const double share  = slides ? limit / size : 1.;
        for (unsigned int d = 1; d < 3; ++d)
          {
            const unsigned int row = 3 * k + d;
            right[row]             = share * trial[d] - F[d];
            for (unsigned int e = 1; e < 3; ++e)
              {
                double P = d == e ? share : 0.;
                if (slides)
                  P -= share * trial[d] * trial[e] / (size * size);
                system(row, 3 * k + e) -= (1. - softness) * P;
                for (unsigned int j = 0; j < n; ++j)
                  system(row, j) += P * r * W[e * n + j];
              }
            if (slides && !open && F[0] > 0.)
              system(row, 3 * k) -= limits.with_pressure() * trial[d] / size;
          }
      }
    };
  } // namespace


  // One step of Newton's iteration for all points together, on the law of
  // contact without inequalities (Alart and Curnier 1991): with g the gap, r a
  // stiffness and the trial F - r g, a point is closed if the normal trial
  // exceeds the tension, and slides if the tangential one exceeds its limit L;
  // then F_t = L trial / |trial|.
  double
  ContactSolver::newton_step(Points &points, const Cluster &cluster)
  {
    const unsigned int       n = 3 * cluster.n_points;
    LAPACKFullMatrix<double> system(n);
    Vector<double>           change(n);
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      {
        const double *W   = &cluster.delassus[3 * k * n];
        double        D   = 0.;
        Tensor<1, 3>  gap = gaps[k];
        for (unsigned int d = 0; d < 3; ++d)
          {
            D = std::max(D, W[d * n + 3 * k + d]);
            for (unsigned int j = 0; j < n; ++j)
              gap[d] +=
                W[d * n + j] * points[cluster.first_point + j / 3].force[j % 3];
            system(3 * k + d, 3 * k + d) = 1.;
          }
        // both nodes are fixed, or their interface is not grouted yet
        if (D == 0. || !points[cluster.first_point + k].joined)
          continue;
        const NewtonPoint rows{
          k, points[cluster.first_point + k], W, gap, 1. / D, system, change};
        rows.set_normal_row();
        rows.set_tangential_rows();
      }

    try
      {
        system.compute_lu_factorization();
      }
    catch (const LACExceptions::ExcSingular &)
      {
        return 0.;
      }
    system.solve(change);
    for (unsigned int i = 0; i < n; ++i)
      points[cluster.first_point + i / 3].force[i % 3] += change[i];
    return change.linfty_norm();
  }
} // namespace Voussoir
