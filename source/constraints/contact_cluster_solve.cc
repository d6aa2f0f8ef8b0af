// The contact of clusters of several points.

#include <voussoir/constraints/contact_solver.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Forces are found when they change by less than this part, or move their
    // points by less than this part of the displacement, which is round-off.
    constexpr double accuracy = 1e-12, round_off = 1e-13;

    // Part of a point's own flexibility by which Newton's iteration softens it:
    // forces between more points than the nodes can tell apart stay finite.
    constexpr double softness = 1e-3;

    constexpr unsigned int max_newton_steps = 10;

  } // namespace


  // The pseudo-inverse of the flexibility of all points together. It is
  // singular where nodes are held and where points form a ring; of the forces
  // that do the same, those with the most even stresses are taken (weights by
  // area).
  void
  ContactSolver::make_matrices(Cluster &cluster) const
  {
    const unsigned int       n = 3 * cluster.n_points;
    LAPACKFullMatrix<double> matrix(n);
    std::vector<double>      weight(n);
    cluster.flexibility.resize(n * n);
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
                cluster.flexibility[(3 * k + d) * n + 3 * l + e] = block[d][e];
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
  ContactSolver::solve_cluster(const Cluster                   &cluster,
                               const std::vector<Tensor<1, 3>> &displacement,
                               Effort                          &effort)
  {
    const auto add_to_moves = [&](const ContactPoint &point,
                                  const Tensor<1, 3> &force) {
      const Tensor<1, 3> global = force * point.frame;
      moves[point.second - cluster.first_node] += motion(point.second, global);
      moves[point.first - cluster.first_node] -= motion(point.first, global);
    };
    const auto relative_move = [&](const ContactPoint &point) {
      return point.frame * (moves[point.second - cluster.first_node] -
                            moves[point.first - cluster.first_node]);
    };

    bool held = true, given = false;
    std::fill_n(moves.begin(), cluster.n_nodes, Tensor<1, 3>());
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      {
        const ContactPoint &point = points[cluster.first_point + k];
        gaps[k] =
          gap_to_hold(point,
                      displacement[point.second] - displacement[point.first]);
        held = held && point.status == ContactStatus::sticking;
        if (point.given_force != 0.)
          {
            given = true;
            Tensor<1, 3> force;
            force[0] = point.given_force;
            add_to_moves(point, force);
          }
      }
    if (given)
      for (unsigned int k = 0; k < cluster.n_points; ++k)
        gaps[k] += relative_move(points[cluster.first_point + k]);
    if (held && hold_all(cluster))
      return;

    // from the forces of the step before
    const auto start_from_forces = [&] {
      std::fill_n(moves.begin(), cluster.n_nodes, Tensor<1, 3>());
      for (unsigned int k = 0; k < cluster.n_points; ++k)
        add_to_moves(points[cluster.first_point + k],
                     points[cluster.first_point + k].force);
    };
    start_from_forces();
    double     change = 1., largest = 0.;
    const auto iterate = [&](const bool shear_too) {
      for (unsigned int i = 0; i < max_newton_steps; ++i)
        if (newton_step(cluster, shear_too) <= accuracy * largest)
          return;
    };
    double size = 0., moved = 1.;
    for (unsigned int i = 0; i < cluster.n_nodes; ++i)
      size = std::max(size, displacement[cluster.first_node + i].norm());
    const auto found = [&] {
      return change <= accuracy * largest || moved <= round_off * size;
    };
    unsigned int sweep = 0;
    for (; sweep < max_sweeps && !found(); ++sweep)
      {
        // Cohesion that ends at opening may leave no solution: a point opens
        // with it and closes without. Then there is none in this step.
        if (sweep == max_sweeps / 2)
          for (unsigned int k = 0; k < cluster.n_points; ++k)
            points[cluster.first_point + k].limits.cohesion = 0.;

        // a jump ahead where it goes slowly, taken back if it was a wrong one
        const double change_before = change, moved_before = moved;
        const bool   jumped = sweep % 5 == 4;
        if (jumped)
          {
            for (unsigned int k = 0; k < cluster.n_points; ++k)
              holding[k] = points[cluster.first_point + k].force;
            iterate(true);
            start_from_forces();
          }

        change = largest = moved = 0.;
        for (unsigned int k = 0; k < cluster.n_points; ++k)
          {
            const unsigned int number = cluster.first_point + k;
            ContactPoint      &point  = points[number];
            const Tensor<1, 3> before = point.force;
            solve_point(number,
                        gaps[k] + relative_move(point) -
                          relative_motion(number, before));
            add_to_moves(point, point.force - before);
            change = std::max(change, (point.force - before).norm());
            moved =
              std::max(moved,
                       relative_motion(number, point.force - before).norm());
            largest = std::max(largest, point.force.norm());
          }
        if (jumped && !(change <= change_before))
          {
            for (unsigned int k = 0; k < cluster.n_points; ++k)
              points[cluster.first_point + k].force = holding[k];
            start_from_forces();
            change = change_before;
            moved  = moved_before;
          }
      }
    // friction may leave no solution either; then at least nothing penetrates
    if (!found())
      iterate(false);
    if (sweep > max_sweeps / 2)
      for (unsigned int k = 0; k < cluster.n_points; ++k)
        update_limits(points[cluster.first_point + k]);
    effort.sweeps = std::max(effort.sweeps, sweep);
    effort.all_sweeps += sweep;
    ++effort.clusters;
    if (largest > 0.)
      effort.residual = std::max(effort.residual, change / largest);
  }


  bool
  ContactSolver::hold_all(const Cluster &cluster)
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
        if (force[0] < (limits.opening > 0. ? 0. : -limits.tension) ||
            tangential_norm(force) > limits.shear(false, force[0]))
          return false;
        holding[k] = force;
      }
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      points[cluster.first_point + k].force = holding[k];
    return true;
  }


  // One step of Newton's iteration for all points together, on the law of
  // contact without inequalities (Alart and Curnier 1991): with g the gap, r a
  // stiffness and the trial F - r g, a point is closed if the normal trial
  // exceeds the tension, and slides if the tangential one exceeds its limit L,
  // against which it then is F_t = L trial / |trial|.
  double
  ContactSolver::newton_step(const Cluster &cluster, const bool shear_too)
  {
    const unsigned int n = 3 * cluster.n_points;
    std::fill_n(system.begin(), n * n, 0.);
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      {
        const ContactPoint  &point  = points[cluster.first_point + k];
        const ContactLimits &limits = point.limits;
        const Tensor<1, 3>  &F      = point.force;
        const double        *W      = &cluster.flexibility[3 * k * n];
        double              *row    = &system[3 * k * n];
        double              *right  = &unknowns[3 * k];
        double               D      = 0.;
        Tensor<1, 3>         gap    = gaps[k];
        for (unsigned int d = 0; d < 3; ++d)
          {
            D = std::max(D, W[d * n + 3 * k + d]);
            for (unsigned int j = 0; j < n; ++j)
              gap[d] +=
                W[d * n + j] * points[cluster.first_point + j / 3].force[j % 3];
            row[d * n + 3 * k + d] = 1.;
            right[d]               = 0.;
          }
        if (D == 0.) // both nodes are held
          continue;
        const double       r     = 1. / D;
        const Tensor<1, 3> trial = F - r * gap;

        const bool bond = limits.opening > 0. && limits.tension > 0.;
        const bool open =
          trial[0] < (limits.opening > 0. ? 0. : -limits.tension);
        if (!open)
          {
            for (unsigned int j = 0; j < n; ++j)
              row[j] = r * W[j];
            row[3 * k] += softness;
            right[0] = -r * gap[0];
          }
        else if (bond && gap[0] < limits.opening)
          {
            // unloads towards zero opening
            const double secant = limits.tension / limits.opening;
            for (unsigned int j = 0; j < n; ++j)
              row[j] += secant * W[j];
            right[0] = -secant * gap[0] - F[0];
          }
        else
          right[0] = -limits.tension - F[0];

        if (!shear_too)
          continue;
        const double limit  = limits.shear(open, F[0]);
        const double size   = tangential_norm(trial);
        const bool   slides = size > limit;
        const double share  = slides ? limit / size : 1.;
        for (unsigned int d = 1; d < 3; ++d)
          {
            double *R = row + d * n;
            right[d]  = share * trial[d] - F[d];
            for (unsigned int e = 1; e < 3; ++e)
              {
                double P = d == e ? share : 0.;
                if (slides)
                  P -= share * trial[d] * trial[e] / (size * size);
                R[3 * k + e] -= (1. - softness) * P;
                for (unsigned int j = 0; j < n; ++j)
                  R[j] += P * r * W[e * n + j];
              }
            if (slides && !open && F[0] > 0.)
              R[3 * k] -= limits.friction * trial[d] / size;
          }
      }

    // Gaussian elimination with row pivots
    for (unsigned int column = 0; column < n; ++column)
      {
        unsigned int pivot = column;
        for (unsigned int i = column + 1; i < n; ++i)
          if (std::abs(system[i * n + column]) >
              std::abs(system[pivot * n + column]))
            pivot = i;
        if (system[pivot * n + column] == 0.)
          return 0.;
        if (pivot != column)
          {
            std::swap_ranges(&system[pivot * n],
                             &system[pivot * n] + n,
                             &system[column * n]);
            std::swap(unknowns[pivot], unknowns[column]);
          }
        for (unsigned int i = column + 1; i < n; ++i)
          {
            const double factor =
              system[i * n + column] / system[column * n + column];
            if (factor == 0.)
              continue;
            for (unsigned int j = column; j < n; ++j)
              system[i * n + j] -= factor * system[column * n + j];
            unknowns[i] -= factor * unknowns[column];
          }
      }
    double largest = 0.;
    for (unsigned int i = n; i-- > 0;)
      {
        for (unsigned int j = i + 1; j < n; ++j)
          unknowns[i] -= system[i * n + j] * unknowns[j];
        unknowns[i] /= system[i * n + i];
        points[cluster.first_point + i / 3].force[i % 3] += unknowns[i];
        largest = std::max(largest, std::abs(unknowns[i]));
      }
    return largest;
  }
} // namespace Voussoir
