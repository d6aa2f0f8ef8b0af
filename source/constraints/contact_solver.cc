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


    double
    lasting_friction(const ContactPoint &point, const double coefficient)
    {
      return coefficient * (1. - point.at_once) * point.mean_pressure;
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
          std::max(point.history.opening, point.initial_gap[0]);
        if (!point.joined || point.initial_gap[0] > 0.)
          point.status = ContactStatus::open;
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
        ContactPoint &point = points[k];
        point.at_once =
          point.delay > 0. ? -std::expm1(-time_step / point.delay) : 1.;
        update_limits(point);
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


  void
  ContactSolver::find_gaps(const std::vector<Tensor<1, 3>> &displacement)
  {
    for (ContactPoint &point : points)
      {
        point.gap = point.frame *
                      (displacement[point.second] - displacement[point.first]) +
                    point.initial_gap;
        update_limits(point);
      }
  }


  void
  ContactSolver::start(const std::vector<Tensor<1, 3>> &displacement,
                       const std::vector<Tensor<1, 3>> &velocity)
  {
    find_gaps(displacement);
    for (ContactPoint &point : points)
      point.velocity =
        point.frame * (velocity[point.second] - velocity[point.first]);
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
                                        surface.key_depth > 0. && point.gap[0] < surface.key_depth,
                                        lasting_friction(point, strength.friction),
                                        point.at_once};
    double bars                      = 0.;
    if (surface.bar_stiffness > 0.)
      bars = surface.bar_stiffness *
             (point.gap[0] - point.initial_gap[0] - point.bar_extension);
    point.given_force = (point.uplift - bars) * point.area;
  }


  void
  ContactSolver::catch_up_with_pressure(ContactPoint &point) const
  {
    point.mean_pressure = std::max(point.force[0], 0.);
    update_limits(point);
  }


  void
  ContactSolver::yield_bars(ContactPoint &point) const
  {
    const ContactSurface &surface = surfaces[point.surface];
    if (surface.bar_stiffness == 0.)
      return;
    const double extension = point.gap[0] - point.initial_gap[0],
                 elastic   = surface.bar_strength / surface.bar_stiffness;
    point.bar_extension =
      std::max(extension - elastic,
               std::min(extension + elastic, point.bar_extension));
  }


  Tensor<1, 3>
  ContactSolver::total_force(const ContactPoint &point)
  {
    Tensor<1, 3> force = point.force;
    force[0] += point.given_force;
    return force * point.frame;
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
  ContactSolver::solve_point(const unsigned int number, const Tensor<1, 3> &gap)
  {
    ContactPoint &point = points[number];
    if (!point.joined)
      return;
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


  double
  ContactSolver::update(ContactPoint                    &point,
                        const std::vector<Tensor<1, 3>> &displacement)
  {
    ContactSurface    &surface = surfaces[point.surface];
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
    yield_bars(point);
    point.mean_pressure +=
      point.at_once * (std::max(F[0], 0.) - point.mean_pressure);
    point.limits.lasting = lasting_friction(point, point.limits.friction);
    // keys may have closed
    if (point.status != ContactStatus::sticking || surface.bar_stiffness > 0. ||
        (surface.key_depth > 0. && !point.limits.locked))
      update_limits(point);
    return std::max(0., -point.gap[0]);
  }
} // namespace Voussoir
