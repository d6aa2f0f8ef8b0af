#include <voussoir/constraints/contact_solver.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Forces are found when they change by less than this part.
    constexpr double accuracy = 1e-12;

    // std::hypot minds overflow, at ten times the cost
    double
    length(const double x, const double y)
    {
      return std::sqrt(x * x + y * y);
    }


    bool
    is_multiple_of_identity(const Tensor<2, 3> &matrix)
    {
      for (unsigned int d = 0; d < 3; ++d)
        for (unsigned int e = 0; e < 3; ++e)
          if (matrix[d][e] != (d == e ? matrix[0][0] : 0.))
            return false;
      return true;
    }


    /** The gap less the slip at the last stick, which is what the contact
     *  force has to undo. */
    Tensor<1, 3>
    gap_to_hold(const ContactPoint &point, const Tensor<1, 3> &relative)
    {
      Tensor<1, 3> gap = point.frame * relative;
      gap[0] += point.initial_gap;
      gap[1] -= point.stick_point[0];
      gap[2] -= point.stick_point[1];
      return gap;
    }


    /** All that acts on the second node, in global coordinates. */
    Tensor<1, 3>
    total_force(const ContactPoint &point)
    {
      Tensor<1, 3> force = point.force;
      force[0] += point.given_force;
      return force * point.frame;
    }
  } // namespace


  ContactSolver::ContactSolver(const std::vector<ContactSurface> &surfaces)
    : surfaces(surfaces)
  {}


  void
  ContactSolver::add_cluster(const unsigned int               n_nodes,
                             const std::vector<ContactPoint> &added)
  {
    const unsigned int first_point = points.size();
    for (ContactPoint point : added)
      {
        point.first += number_of_nodes;
        point.second += number_of_nodes;
        point.history.opening =
          std::max(point.history.opening, point.initial_gap);
        update_limits(point);
        points.push_back(point);
      }
    if (added.size() == 1)
      {
        Assert(clusters.empty(), ExcMessage("Clusters of one point first"));
        ++n_single;
      }
    else
      {
        const unsigned int n_points = added.size();
        clusters.push_back(
          {number_of_nodes, n_nodes, first_point, n_points, {}, {}});
        gaps.resize(std::max<std::size_t>(gaps.size(), n_points));
        moves.resize(std::max<std::size_t>(moves.size(), n_nodes));
        holding.resize(gaps.size());
        system.resize(9 * gaps.size() * gaps.size());
        unknowns.resize(3 * gaps.size());
        column_of_row.resize(3 * gaps.size());
      }
    number_of_nodes += n_nodes;
  }


  unsigned int
  ContactSolver::n_nodes() const
  {
    return number_of_nodes;
  }


  void
  ContactSolver::prepare_step(const std::vector<Tensor<2, 3>> &inverse_mass,
                              const double                     step)
  {
    AssertDimension(inverse_mass.size(), number_of_nodes);
    time_step = step;
    node_flexibility.assign(number_of_nodes, -1.);
    node_matrix.resize(number_of_nodes);
    for (unsigned int node = 0; node < number_of_nodes; ++node)
      {
        node_matrix[node] = time_step * time_step * inverse_mass[node];
        if (is_multiple_of_identity(node_matrix[node]))
          node_flexibility[node] = node_matrix[node][0][0];
      }

    point_flexibility.assign(points.size(), -1.);
    matrix_of_point.assign(points.size(), 0);
    point_matrix.clear();
    for (unsigned int k = 0; k < points.size(); ++k)
      {
        const auto  &point  = points[k];
        const double first  = node_flexibility[point.first],
                     second = node_flexibility[point.second];
        if (first >= 0. && second >= 0.)
          point_flexibility[k] = first + second;
        else
          {
            matrix_of_point[k] = point_matrix.size();
            point_matrix.emplace_back(
              point.frame *
              (node_matrix[point.first] + node_matrix[point.second]) *
              transpose(point.frame));
          }
      }
    for (Cluster &cluster : clusters)
      make_matrices(cluster);
  }


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
  ContactSolver::start(const std::vector<Tensor<1, 3>> &displacement,
                       const std::vector<Tensor<1, 3>> &velocity)
  {
    for (ContactPoint &point : points)
      {
        point.gap = point.frame *
                    (displacement[point.second] - displacement[point.first]);
        point.gap[0] += point.initial_gap;
        point.velocity =
          point.frame * (velocity[point.second] - velocity[point.first]);
        update_limits(point);
      }
  }


  void
  ContactSolver::update_limits(ContactPoint &point) const
  {
    const ContactSurface   &surface  = surfaces[point.surface];
    const InterfaceStrength strength = surface.law->strength(point.history);
    point.limits                     = {strength.tension * point.area,
                                        strength.bond * point.area,
                                        strength.cohesion * point.area,
                                        strength.friction,
                                        point.history.opening,
                                        surface.key_depth > 0. && point.gap[0] < surface.key_depth};
    double bars                      = 0.;
    if (surface.bar_stiffness > 0.)
      bars = surface.bar_stiffness *
             (point.gap[0] - point.initial_gap - point.bar_extension);
    point.given_force = (point.uplift - bars) * point.area;
  }


  double
  ContactSolver::bar_share_of_stable_step(const unsigned int number) const
  {
    Tensor<1, 3> unit;
    unit[0] = 1.;
    return 0.25 * surfaces[points[number].surface].bar_stiffness *
           points[number].area * relative_motion(number, unit)[0];
  }


  Tensor<1, 3>
  ContactSolver::motion(const unsigned int  node,
                        const Tensor<1, 3> &force) const
  {
    return node_flexibility[node] >= 0. ? node_flexibility[node] * force :
                                          node_matrix[node] * force;
  }


  Tensor<1, 3>
  ContactSolver::relative_motion(const unsigned int  number,
                                 const Tensor<1, 3> &force) const
  {
    return point_flexibility[number] >= 0. ?
             point_flexibility[number] * force :
             point_matrix[matrix_of_point[number]].full * force;
  }


  void
  ContactSolver::solve_point(const unsigned int number, const Tensor<1, 3> &gap)
  {
    ContactPoint      &point = points[number];
    const ContactForce found =
      point_flexibility[number] >= 0. ?
        solve_contact(gap, point_flexibility[number], point.limits) :
        solve_contact(gap, point_matrix[matrix_of_point[number]], point.limits);
    point.force  = found.force;
    point.status = found.status;
  }


  ContactSolver::Effort
  ContactSolver::solve(std::vector<Tensor<1, 3>> &displacement,
                       std::vector<Tensor<1, 3>> &force)
  {
    Effort effort;
    for (unsigned int k = 0; k < n_single; ++k)
      {
        ContactPoint &point = points[k];
        Tensor<1, 3>  gap =
          gap_to_hold(point,
                      displacement[point.second] - displacement[point.first]);
        if (point.given_force != 0.)
          {
            Tensor<1, 3> given;
            given[0] = point.given_force;
            gap += relative_motion(k, given);
          }
        solve_point(k, gap);
        force[point.second] = total_force(point);
        force[point.first]  = -force[point.second];
        displacement[point.second] += motion(point.second, force[point.second]);
        displacement[point.first] += motion(point.first, force[point.first]);
        effort.penetration =
          std::max(effort.penetration, update(point, displacement));
      }

    for (const Cluster &cluster : clusters)
      {
        solve_cluster(cluster, displacement, effort);
        for (unsigned int i = 0; i < cluster.n_nodes; ++i)
          force[cluster.first_node + i] = Tensor<1, 3>();
        for (unsigned int k = 0; k < cluster.n_points; ++k)
          {
            const ContactPoint &point = points[cluster.first_point + k];
            const Tensor<1, 3>  total = total_force(point);
            force[point.second] += total;
            force[point.first] -= total;
          }
        for (unsigned int i = 0; i < cluster.n_nodes; ++i)
          displacement[cluster.first_node + i] +=
            motion(cluster.first_node + i, force[cluster.first_node + i]);
        for (unsigned int k = 0; k < cluster.n_points; ++k)
          effort.penetration =
            std::max(effort.penetration,
                     update(points[cluster.first_point + k], displacement));
      }
    return effort;
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
    double       change = 1., largest = 0.;
    unsigned int sweep = 0;
    for (; sweep < max_sweeps && change > accuracy * largest; ++sweep)
      {
        // a jump ahead where it goes slowly, taken back if it was a wrong one
        const double before_jump = change;
        const bool   jumped      = sweep % 10 == 9;
        if (jumped)
          {
            for (unsigned int k = 0; k < cluster.n_points; ++k)
              holding[k] = points[cluster.first_point + k].force;
            solve_as_they_stand(cluster);
            start_from_forces();
          }

        change  = 0.;
        largest = 0.;
        for (unsigned int k = 0; k < cluster.n_points; ++k)
          {
            const unsigned int number = cluster.first_point + k;
            ContactPoint      &point  = points[number];
            const Tensor<1, 3> before = point.force;
            solve_point(number,
                        gaps[k] + relative_move(point) -
                          relative_motion(number, before));
            add_to_moves(point, point.force - before);
            change  = std::max(change, (point.force - before).norm());
            largest = std::max(largest, point.force.norm());
          }
        if (jumped && change > before_jump)
          {
            for (unsigned int k = 0; k < cluster.n_points; ++k)
              points[cluster.first_point + k].force = holding[k];
            start_from_forces();
            change = before_jump;
          }
      }
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
            length(force[1], force[2]) > limits.shear(false, force[0]))
          return false;
        holding[k] = force;
      }
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      points[cluster.first_point + k].force = holding[k];
    return true;
  }


  // The forces if no point changes between open, sliding and sticking, nor the
  // direction in which it slides: a linear system, by elimination.
  void
  ContactSolver::solve_as_they_stand(const Cluster &cluster)
  {
    const unsigned int n = 3 * cluster.n_points;
    std::fill_n(system.begin(), n * n, 0.);
    for (unsigned int k = 0; k < cluster.n_points; ++k)
      {
        const ContactPoint &point = points[cluster.first_point + k];
        const Tensor<1, 3> &F     = point.force;
        const double        shear = length(F[1], F[2]);
        for (unsigned int d = 0; d < 3; ++d)
          {
            const unsigned int row = 3 * k + d;
            if (point.status == ContactStatus::sticking ||
                (point.status == ContactStatus::sliding && d == 0))
              {
                std::copy_n(&cluster.flexibility[row * n], n, &system[row * n]);
                unknowns[row] = -gaps[k][d];
                continue;
              }
            system[row * n + row] = 1.;
            unknowns[row]         = F[d];
            if (point.status == ContactStatus::sliding && shear > 0.)
              {
                const double friction = F[0] > 0. ? point.limits.friction : 0.;
                system[row * n + 3 * k] = -friction * F[d] / shear;
                unknowns[row] -= friction * F[0] * F[d] / shear;
              }
          }
      }

    // for the change of the forces; where they are not unique, as in a ring of
    // held points, some stay as they are
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        unknowns[i] -=
          system[i * n + j] * points[cluster.first_point + j / 3].force[j % 3];
    for (unsigned int i = 0; i < n; ++i)
      {
        double size = 0.; // rows are of different units
        for (unsigned int j = 0; j < n; ++j)
          size = std::max(size, std::abs(system[i * n + j]));
        if (size == 0.)
          continue;
        for (unsigned int j = 0; j < n; ++j)
          system[i * n + j] /= size;
        unknowns[i] /= size;
      }
    unsigned int row = 0;
    for (unsigned int column = 0; column < n && row < n; ++column)
      {
        unsigned int pivot = row;
        for (unsigned int i = row + 1; i < n; ++i)
          if (std::abs(system[i * n + column]) >
              std::abs(system[pivot * n + column]))
            pivot = i;
        if (std::abs(system[pivot * n + column]) < 1e-9)
          continue;
        std::swap_ranges(&system[pivot * n],
                         &system[pivot * n] + n,
                         &system[row * n]);
        std::swap(unknowns[pivot], unknowns[row]);
        // above it too, so that what is left can be read off
        for (unsigned int i = 0; i < n; ++i)
          if (i != row)
            {
              const double factor =
                system[i * n + column] / system[row * n + column];
              if (factor == 0.)
                continue;
              for (unsigned int j = column; j < n; ++j)
                system[i * n + j] -= factor * system[row * n + j];
              unknowns[i] -= factor * unknowns[row];
            }
        column_of_row[row++] = column;
      }
    for (unsigned int i = 0; i < row; ++i)
      {
        const unsigned int j = column_of_row[i];
        points[cluster.first_point + j / 3].force[j % 3] +=
          unknowns[i] / system[i * n + j];
      }
  }


  double
  ContactSolver::update(ContactPoint                    &point,
                        const std::vector<Tensor<1, 3>> &displacement)
  {
    ContactSurface    &surface = surfaces[point.surface];
    const Tensor<1, 3> before  = point.gap;
    point.gap =
      point.frame * (displacement[point.second] - displacement[point.first]);
    point.gap[0] += point.initial_gap;
    const Tensor<1, 3> velocity = (1. / time_step) * (point.gap - before);

    // work at the mean of the velocities before and after, as in the balance of
    // central differences
    const Tensor<1, 3>  way    = 0.5 * time_step * (velocity + point.velocity);
    const Tensor<1, 3> &F      = point.force;
    ContactEnergy      &energy = surface.energy;
    (F[0] > 0. ? energy.impact : energy.bond) -= F[0] * way[0];
    const double shear_work = -(F[1] * way[1] + F[2] * way[2]);
    double       of_bond    = 0.;
    if (point.limits.bond > 0. && point.status != ContactStatus::sticking)
      of_bond = point.limits.bond /
                point.limits.shear(point.status == ContactStatus::open, F[0]);
    energy.bond += of_bond * shear_work;
    energy.friction += (1. - of_bond) * shear_work;
    const double uplift = point.uplift * point.area;
    energy.uplift -= uplift * way[0];
    energy.bars -= (point.given_force - uplift) * way[0];
    point.velocity = velocity;

    const bool open = point.status == ContactStatus::open;
    if (open)
      point.history.opening = std::max(point.history.opening, point.gap[0]);
    if (point.status != ContactStatus::sticking && !point.limits.locked)
      {
        if (!open || point.limits.bond > 0.)
          point.history.slip +=
            length(point.gap[1] - before[1], point.gap[2] - before[2]);
        point.stick_point[0] = point.gap[1];
        point.stick_point[1] = point.gap[2];
        point.largest_slip =
          std::max(point.largest_slip, length(point.gap[1], point.gap[2]));
      }
    if (surface.bar_stiffness > 0.)
      {
        const double extension = point.gap[0] - point.initial_gap,
                     elastic   = surface.bar_strength / surface.bar_stiffness;
        point.bar_extension =
          std::max(extension - elastic,
                   std::min(extension + elastic, point.bar_extension));
      }
    if (point.status != ContactStatus::sticking || surface.bar_stiffness > 0.)
      update_limits(point);
    return std::max(0., -point.gap[0]);
  }
} // namespace Voussoir
