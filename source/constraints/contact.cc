#include <voussoir/base/mpi.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/grid/face_distance.h>
#include <voussoir/mesh/interfaces.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Rows n, t1 (level), t2 (upwards). */
    Tensor<2, 3>
    frame_of(const Tensor<1, 3> &normal)
    {
      Tensor<1, 3> axis;
      axis[std::abs(normal[2]) < 0.999 ? 2 : 1] = 1.;
      Tensor<1, 3> level = cross_product_3d(axis, normal);
      level /= level.norm();
      Tensor<2, 3> frame;
      frame[0] = normal;
      frame[1] = level;
      frame[2] = cross_product_3d(normal, level);
      return frame;
    }
  } // namespace


  Contact::Contact(const Discretization       &discretization,
                   const InterfacesParameters &interfaces)
    : interfaces(interfaces)
    , names(interfaces.surfaces())
    , communicator(discretization.grid.communicator())
  {
    std::vector<ContactSurface> surfaces;
    for (unsigned int i = 0; i < interfaces.list.size(); ++i)
      for (std::size_t s = 0; s < interfaces.list[i].surfaces.size(); ++s)
        {
          ContactSurface surface;
          surface.law       = interfaces.list[i].law.get();
          surface.key_depth = interfaces.list[i].key_depth;
          surfaces.push_back(surface);
          interface_of_surface.push_back(i);
        }
    solver.emplace(surfaces);

    auto clusters = find_contact_clusters(discretization, names);
    std::stable_partition(clusters.begin(),
                          clusters.end(),
                          [](const ContactCluster &cluster) {
                            return cluster.pairs.size() == 1;
                          });
    for (const ContactCluster &cluster : clusters)
      {
        std::vector<ContactPoint> points;
        for (const ContactPair &pair : cluster.pairs)
          {
            // their order in a cluster is the same on all partitions
            point_keys.push_back(256 * cluster.key + points.size());
            ContactPoint point;
            point.surface = pair.interface;
            point.first   = pair.first;
            point.second  = pair.second;
            point.frame   = frame_of(pair.normal);
            point.area    = pair.area;
            point.joined  = false;
            points.push_back(point);
            point_positions.push_back(cluster.position);
            forces_unique.push_back(cluster.pairs.size() <
                                    cluster.nodes.size());
            first_node.push_back(cluster.nodes[pair.first]);
          }
        solver->add_cluster(cluster.nodes.size(), points);
        global_nodes.insert(global_nodes.end(),
                            cluster.nodes.begin(),
                            cluster.nodes.end());
      }
    find_uplift(discretization);
    for (const InterfaceParameters &interface : interfaces.list)
      has_water.push_back(interface.uplift.comes_with.empty());

    exchange.emplace(discretization, global_nodes);
    displacement.resize(global_nodes.size());
    for (unsigned int i = 0; i < interfaces.list.size(); ++i)
      if (interfaces.list[i].grouted_after.empty())
        join(i);
    force.resize(global_nodes.size());
    applied.resize(exchange->owned_nodes().size());
    last_velocity.resize(applied.size());

    cell_size = std::numeric_limits<double>::max();
    for (const std::string &name : names)
      discretization.grid.for_each_face(
        name, [&](const auto &cell, const unsigned int) {
          cell_size = std::min(cell_size, cell->minimum_vertex_distance());
        });
    cell_size = Utilities::MPI::min(cell_size, communicator);
  }


  double
  Contact::set_delay(
    const Discretization                            &discretization,
    const std::function<double(const Grid::Cell &)> &wave_speed)
  {
    // 2 leave some chatter where friction is above 0.7 (see doc/theory.md)
    constexpr double cells = 4.;

    // sums and numbers of them at the nodes of the surfaces
    Vector times(discretization.owned_dofs,
                 discretization.relevant_dofs,
                 communicator);
    for (const std::string &name : names)
      for (const std::string &side : {name, name + other_side})
        discretization.grid.for_each_face(
          side, [&](const auto &cell, const unsigned int) {
            const double length =
              cell->minimum_vertex_distance() / discretization.degree;
            for (const types::global_dof_index node :
                 discretization.cell_nodes(discretization.dof_cell(cell)))
              {
                times(3 * node) += length / wave_speed(cell);
                times(3 * node + 1) += 1.;
              }
          });
    times.compress(VectorOperation::add);
    exchange->to_clusters(times, displacement);
    const auto mean_at = [&](const unsigned int node) {
      return displacement[node][0] / displacement[node][1];
    };
    double largest = 0.;
    for (unsigned int k = 0; k < solver->points.size(); ++k)
      if (forces_unique[k])
        {
          ContactPoint &point = solver->points[k];
          point.delay =
            cells * std::max(mean_at(point.first), mean_at(point.second));
          largest = std::max(largest, point.delay);
        }
    std::fill(displacement.begin(), displacement.end(), Tensor<1, 3>());
    return Utilities::MPI::max(largest, communicator);
  }


  void
  Contact::find_uplift(const Discretization &discretization)
  {
    uplift.resize(solver->points.size());
    for (unsigned int i = 0; i < interfaces.list.size(); ++i)
      if (const auto &water = interfaces.list[i].uplift; water.given())
        {
          const std::string place =
            "in section \"Interfaces/" + interfaces.list[i].name + "/Uplift\"";
          const FaceDistance upstream(discretization.grid,
                                      split_list(water.upstream_faces),
                                      "\"Upstream faces\" " + place);
          const FaceDistance downstream(discretization.grid,
                                        split_list(water.downstream_faces),
                                        "\"Downstream faces\" " + place);
          for (unsigned int k = 0; k < solver->points.size(); ++k)
            {
              if (interface_of_surface[solver->points[k].surface] != i)
                continue;
              const Point<3> &x  = point_positions[k];
              const double    up = upstream(x), down = downstream(x);
              uplift[k] = water.pressure(x[2], up > 0. ? up / (up + down) : 0.);
            }
        }
  }


  void
  Contact::join(const unsigned int interface)
  {
    const InterfaceParameters &joined = interfaces.list[interface];
    for (unsigned int s = 0; s < solver->surfaces.size(); ++s)
      if (interface_of_surface[s] == interface)
        {
          ContactSurface &surface = solver->surfaces[s];
          surface.bar_stiffness =
            joined.steel_ratio * joined.steel_modulus / joined.free_length;
          surface.bar_strength = joined.steel_ratio * joined.yield_stress;
        }
    for (unsigned int k = 0; k < solver->points.size(); ++k)
      {
        ContactPoint &point = solver->points[k];
        if (interface_of_surface[point.surface] != interface)
          continue;
        const Tensor<1, 3> motion = point.frame * (displacement[point.second] -
                                                   displacement[point.first]);
        point.joined              = true;
        point.gap                 = Tensor<1, 3>({joined.initial_gap, 0., 0.});
        point.initial_gap         = point.gap - motion;
        point.history             = {joined.initial_gap, 0.};
        point.stick_point         = Tensor<1, 2>();
        point.largest_slip        = 0.;
        point.mean_pressure       = 0.;
        point.bar_extension       = motion[0];
        point.status              = ContactStatus::sticking;
        solver->update_limits(point);
      }
    set_uplift(interface);
  }


  void
  Contact::set_uplift(const unsigned int interface)
  {
    if (!has_water[interface])
      return;
    for (unsigned int k = 0; k < solver->points.size(); ++k)
      {
        ContactPoint &point = solver->points[k];
        if (interface_of_surface[point.surface] == interface && point.joined)
          {
            point.uplift = uplift[k];
            solver->update_limits(point);
          }
      }
  }


  void
  Contact::let_water_in(const std::vector<std::string> &loads)
  {
    for (unsigned int i = 0; i < interfaces.list.size(); ++i)
      if (std::find(loads.begin(),
                    loads.end(),
                    interfaces.list[i].uplift.comes_with) != loads.end())
        {
          has_water[i] = true;
          set_uplift(i);
        }
  }


  bool
  Contact::grout(const std::vector<std::string> &loads,
                 const Vector                   &at_displacement)
  {
    exchange->to_clusters(at_displacement, displacement);
    bool joined = false;
    for (unsigned int i = 0; i < interfaces.list.size(); ++i)
      if (std::find(loads.begin(),
                    loads.end(),
                    interfaces.list[i].grouted_after) != loads.end())
        {
          join(i);
          joined = true;
        }
    return joined;
  }


  void
  Contact::prepare_step(const InverseMass &inverse_mass, const double time_step)
  {
    const auto &owned = exchange->owned_nodes();
    flexibility.assign(owned.size(), -1.);
    full_flexibility.resize(owned.size());
    std::vector<Tensor<2, 3>> owned_inverse(owned.size());
    for (unsigned int i = 0; i < owned.size(); ++i)
      {
        owned_inverse[i]    = inverse_mass(owned[i]);
        full_flexibility[i] = time_step * time_step * owned_inverse[i];
        if (full_flexibility[i] == full_flexibility[i][0][0] *
                                     Tensor<2, 3>(unit_symmetric_tensor<3>()))
          flexibility[i] = full_flexibility[i][0][0];
      }

    // row by row to the ranks of the clusters
    std::vector<Tensor<2, 3>> at_clusters(displacement.size());
    for (unsigned int row = 0; row < 3; ++row)
      {
        std::vector<Tensor<1, 3>> values(owned.size());
        for (unsigned int i = 0; i < owned.size(); ++i)
          values[i] = owned_inverse[i][row];
        exchange->to_clusters(values, displacement);
        for (unsigned int i = 0; i < displacement.size(); ++i)
          at_clusters[i][row] = displacement[i];
      }
    solver->prepare_step(at_clusters, time_step);

    // the bars are springs that the stable time step does not know
    double share = 0.;
    for (unsigned int k = 0; k < solver->points.size(); ++k)
      share = std::max(share, solver->bar_share_of_stable_step(k));
    if (Utilities::MPI::max(share, communicator) > 0.1)
      throw UserError("The bars across an interface are too stiff for the time "
                      "step; choose a larger \"Free length\" in its section "
                      "under \"Interfaces\", or a smaller \"Safety factor\" in "
                      "section \"Time\".");
  }


  void
  Contact::start(const State &state)
  {
    std::vector<Tensor<1, 3>> velocity(displacement.size());
    exchange->to_clusters(state.velocity, velocity);
    exchange->to_clusters(state.displacement, displacement);
    solver->start(displacement, velocity);
    const auto &owned = exchange->owned_nodes();
    for (unsigned int i = 0; i < owned.size(); ++i)
      for (unsigned int d = 0; d < 3; ++d)
        last_velocity[i][d] = state.velocity.local_element(3 * owned[i] + d);
  }


  Projection::Result
  Contact::project(State &state, const double time_step)
  {
    const auto start = std::chrono::steady_clock::now();
    exchange->to_clusters(state.displacement, displacement);
    const auto effort = solver->solve(displacement, force);
    exchange->to_owners(force, applied);

    total.penetration = std::max(total.penetration, effort.penetration);
    total.residual    = std::max(total.residual, effort.residual);
    total.sweeps      = std::max(total.sweeps, effort.sweeps);
    total.all_sweeps += effort.all_sweeps;
    total.clusters += effort.clusters;
    total.paths += effort.paths;
    total.unsolved += effort.unsolved;

    Result result;
    result.violation       = effort.penetration;
    const double frequency = 1. / time_step;
    const auto  &owned     = exchange->owned_nodes();
    for (unsigned int i = 0; i < owned.size(); ++i)
      {
        double            *u      = state.displacement.begin() + 3 * owned[i];
        double            *v      = state.velocity.begin() + 3 * owned[i];
        const bool         simple = flexibility[i] >= 0.;
        const Tensor<1, 3> motion = simple ? flexibility[i] * applied[i] :
                                             full_flexibility[i] * applied[i];
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double momentum = time_step * applied[i][d];
            u[d] += motion[d];
            v[d] += motion[d] * frequency;
            // what holds a node takes the momentum on it
            if (simple ? flexibility[i] > 0. : full_flexibility[i][d][d] > 0.)
              {
                result.impulse[d] += momentum;
                result.work += momentum * 0.5 * (v[d] + last_velocity[i][d]);
              }
            last_velocity[i][d] = v[d];
          }
      }
    wall_time += std::chrono::steady_clock::now() - start;
    return result;
  }


  void
  Contact::begin_approach()
  {
    before_approach.clear();
    for (const ContactPoint &point : solver->points)
      before_approach.push_back(
        {point.history, point.stick_point, point.largest_slip});
  }


  void
  Contact::forget_approach()
  {
    for (unsigned int k = 0; k < solver->points.size(); ++k)
      {
        ContactPoint &point  = solver->points[k];
        const Slid   &before = before_approach[k];
        const bool    open   = point.status == ContactStatus::open;
        point.history        = before.history;
        if (open)
          point.history.opening = std::max(point.history.opening, point.gap[0]);
        if (!open || point.limits.bond > 0.)
          point.history.slip += (point.stick_point - before.stick_point).norm();
        point.largest_slip =
          std::max(before.largest_slip, std::hypot(point.gap[1], point.gap[2]));
        solver->update_limits(point);
      }
    for (ContactSurface &surface : solver->surfaces)
      surface.energy = ContactEnergy();
    total     = ContactSolver::Effort();
    wall_time = {};
  }


  void
  Contact::add_forces(const double factor, Vector &vector) const
  {
    exchange->add(vector, factor, applied);
  }


  const std::vector<unsigned int> &
  Contact::nodes() const
  {
    return exchange->owned_nodes();
  }


  ContactSolver::Effort
  Contact::effort() const
  {
    ContactSolver::Effort result;
    for (const auto largest : {&ContactSolver::Effort::penetration,
                               &ContactSolver::Effort::residual})
      result.*largest = Utilities::MPI::max(total.*largest, communicator);
    result.sweeps = Utilities::MPI::max(total.sweeps, communicator);
    for (const auto sum : {&ContactSolver::Effort::all_sweeps,
                           &ContactSolver::Effort::clusters,
                           &ContactSolver::Effort::paths,
                           &ContactSolver::Effort::unsolved})
      result.*sum = Utilities::MPI::sum(total.*sum, communicator);
    return result;
  }


  double
  Contact::seconds() const
  {
    return wall_time.count();
  }


  const std::vector<std::string> &
  Contact::surface_names() const
  {
    return names;
  }


  const std::vector<ContactSurface> &
  Contact::surfaces() const
  {
    return solver->surfaces;
  }


  const std::vector<ContactPoint> &
  Contact::points() const
  {
    return solver->points;
  }


  void
  Contact::set_points(const std::vector<ContactPoint> &points)
  {
    solver->points = points;
  }


  const std::vector<Point<3>> &
  Contact::positions() const
  {
    return point_positions;
  }


  bool
  Contact::touches(const ContactPoint &point) const
  {
    return point.joined && point.gap[0] <= 1e-6 * cell_size;
  }


  const std::vector<std::uint64_t> &
  Contact::keys() const
  {
    return point_keys;
  }


  const std::vector<types::global_dof_index> &
  Contact::cluster_nodes() const
  {
    return global_nodes;
  }


  const std::vector<types::global_dof_index> &
  Contact::first_nodes() const
  {
    return first_node;
  }
} // namespace Voussoir
