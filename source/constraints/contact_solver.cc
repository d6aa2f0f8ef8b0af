#include <voussoir/constraints/contact_solver.h>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    bool
    is_multiple_of_identity(const Tensor<2, 3> &matrix)
    {
      for (unsigned int d = 0; d < 3; ++d)
        for (unsigned int e = 0; e < 3; ++e)
          if (matrix[d][e] != (d == e ? matrix[0][0] : 0.))
            return false;
      return true;
    }
  } // namespace


  void
  ContactSolver::prepare_step(ContactPoints                   &contact,
                              const std::vector<Tensor<2, 3>> &inverse_mass,
                              const double                     step)
  {
    const unsigned int number_of_nodes = contact.n_nodes();
    Points            &points          = contact.points;
    AssertDimension(inverse_mass.size(), number_of_nodes);
    time_step = step;
    node_compliance.assign(number_of_nodes, -1.);
    node_matrix.resize(number_of_nodes);
    for (unsigned int node = 0; node < number_of_nodes; ++node)
      {
        node_matrix[node] = time_step * time_step * inverse_mass[node];
        if (is_multiple_of_identity(node_matrix[node]))
          node_compliance[node] = node_matrix[node][0][0];
      }

    point_delassus.assign(points.size(), -1.);
    operator_of_point.assign(points.size(), 0);
    point_operator.clear();
    for (unsigned int k = 0; k < points.size(); ++k)
      {
        ContactPoint &point = points[k];
        point.at_once =
          point.delay > 0. ? -std::expm1(-time_step / point.delay) : 1.;
        contact.update_limits(point);
        const double first  = node_compliance[point.first],
                     second = node_compliance[point.second];
        if (first >= 0. && second >= 0.)
          point_delassus[k] = first + second;
        else
          {
            operator_of_point[k] = point_operator.size();
            point_operator.emplace_back(
              point.frame *
              (node_matrix[point.first] + node_matrix[point.second]) *
              transpose(point.frame));
          }
      }

    clusters.clear();
    for (const ContactPoints::Cluster &cluster : contact.clusters())
      {
        clusters.push_back({cluster, {}, {}, {}});
        make_matrices(points, clusters.back());
        gaps.resize(std::max<std::size_t>(gaps.size(), cluster.n_points));
        moves.resize(std::max<std::size_t>(moves.size(), cluster.n_nodes));
      }
    candidates.resize(gaps.size());
  }


  double
  ContactSolver::bar_share_of_stable_step(const ContactPoints &contact,
                                          const unsigned int   number) const
  {
    const ContactPoint &point = contact.points[number];
    Tensor<1, 3>        unit;
    unit[0] = 1.;
    return 0.25 * contact.surfaces[point.surface].bar_stiffness * point.area *
           relative_motion(number, unit)[0];
  }


  Tensor<1, 3>
  ContactSolver::motion(const unsigned int  node,
                        const Tensor<1, 3> &force) const
  {
    return node_compliance[node] >= 0. ? node_compliance[node] * force :
                                         node_matrix[node] * force;
  }


  Tensor<1, 3>
  ContactSolver::relative_motion(const unsigned int  number,
                                 const Tensor<1, 3> &force) const
  {
    return point_delassus[number] >= 0. ?
             point_delassus[number] * force :
             point_operator[operator_of_point[number]].full * force;
  }


  Tensor<1, 3>
  ContactSolver::gap_to_hold(const ContactPoint &point,
                             const Tensor<1, 3> &relative)
  {
    Tensor<1, 3> gap = point.frame * relative + point.initial_gap;
    gap[1] -= point.stick_point[0];
    gap[2] -= point.stick_point[1];
    return gap;
  }


  void
  ContactSolver::solve_point(ContactPoint       &point,
                             const unsigned int  number,
                             const Tensor<1, 3> &gap)
  {
    if (!point.joined)
      return;
    const ContactForce found =
      point_delassus[number] >= 0. ?
        solve_contact(gap, point_delassus[number], point.limits) :
        solve_contact(gap,
                      point_operator[operator_of_point[number]],
                      point.limits);
    point.force  = found.force;
    point.status = found.status;
  }


  ContactSolver::Effort
  ContactSolver::solve(ContactPoints             &contact,
                       std::vector<Tensor<1, 3>> &displacement,
                       std::vector<Tensor<1, 3>> &force)
  {
    Points            &points   = contact.points;
    const unsigned int n_single = contact.n_single();
    Effort             effort;
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
        solve_point(point, k, gap);
        force[point.second] = ContactPoints::total_force(point);
        force[point.first]  = -force[point.second];
        displacement[point.second] += motion(point.second, force[point.second]);
        displacement[point.first] += motion(point.first, force[point.first]);
        effort.penetration =
          std::max(effort.penetration, update(contact, point, displacement));
      }

    for (const Cluster &cluster : clusters)
      {
        solve_cluster(points, cluster, displacement, effort);
        for (unsigned int i = 0; i < cluster.n_nodes; ++i)
          force[cluster.first_node + i] = Tensor<1, 3>();
        for (unsigned int k = 0; k < cluster.n_points; ++k)
          {
            const ContactPoint &point = points[cluster.first_point + k];
            const Tensor<1, 3>  total = ContactPoints::total_force(point);
            force[point.second] += total;
            force[point.first] -= total;
          }
        for (unsigned int i = 0; i < cluster.n_nodes; ++i)
          displacement[cluster.first_node + i] +=
            motion(cluster.first_node + i, force[cluster.first_node + i]);
        for (unsigned int k = 0; k < cluster.n_points; ++k)
          effort.penetration = std::max(effort.penetration,
                                        update(contact,
                                               points[cluster.first_point + k],
                                               displacement));
      }
    return effort;
  }


  double
  ContactSolver::update(ContactPoints                   &contact,
                        ContactPoint                    &point,
                        const std::vector<Tensor<1, 3>> &displacement)
  {
    ContactSurface    &surface = contact.surfaces[point.surface];
    const Tensor<1, 3> before  = point.gap;
    point.gap =
      point.frame * (displacement[point.second] - displacement[point.first]) +
      point.initial_gap;
    const Tensor<1, 3> velocity = (1. / time_step) * (point.gap - before);
    if (!point.joined)
      {
        point.velocity = velocity;
        return 0.;
      }

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
          point.history.slip += tangential_norm(point.gap - before);
        point.stick_point[0] = point.gap[1];
        point.stick_point[1] = point.gap[2];
        point.largest_slip =
          std::max(point.largest_slip, tangential_norm(point.gap));
      }
    contact.yield_bars(point);
    point.mean_pressure +=
      point.at_once * (std::max(F[0], 0.) - point.mean_pressure);
    point.limits.lasting = point.lasting_friction(point.limits.friction);
    // keys may have closed
    if (point.status != ContactStatus::sticking || surface.bar_stiffness > 0. ||
        (surface.key_depth > 0. && !point.limits.locked))
      contact.update_limits(point);
    return std::max(0., -point.gap[0]);
  }
} // namespace Voussoir
