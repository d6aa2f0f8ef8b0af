#include <voussoir/base/mpi.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/mesh/face_distance.h>

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
    : names(interfaces.surfaces())
    , communicator(discretization.grid.communicator())
  {
    std::vector<ContactSurface> surfaces;
    for (unsigned int i = 0; i < interfaces.list.size(); ++i)
      for (std::size_t s = 0; s < interfaces.list[i].surfaces.size(); ++s)
        {
          const InterfaceParameters &interface = interfaces.list[i];
          ContactSurface             surface;
          surface.law           = interface.law.get();
          surface.key_depth     = interface.key_depth;
          surface.bar_stiffness = interface.steel_ratio *
                                  interface.steel_modulus /
                                  interface.free_length;
          surface.bar_strength = interface.steel_ratio * interface.yield_stress;
          surfaces.push_back(surface);
          interface_of_surface.push_back(i);
        }
    solver = std::make_unique<ContactSolver>(surfaces);

    auto clusters = find_contact_clusters(discretization, names);
    std::stable_partition(clusters.begin(),
                          clusters.end(),
                          [](const ContactCluster &cluster) {
                            return cluster.pairs.size() == 1;
                          });
    std::vector<types::global_dof_index> nodes;
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
            point.initial_gap =
              interfaces.list[interface_of_surface[pair.interface]].initial_gap;
            points.push_back(point);
            point_positions.push_back(cluster.position);
            first_node.push_back(cluster.nodes[pair.first]);
          }
        solver->add_cluster(cluster.nodes.size(), points);
        nodes.insert(nodes.end(), cluster.nodes.begin(), cluster.nodes.end());
      }
    add_uplift(discretization, interfaces);

    exchange = std::make_unique<ContactExchange>(discretization, nodes);
    displacement.resize(nodes.size());
    force.resize(nodes.size());
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


  void
  Contact::add_uplift(const Discretization       &discretization,
                      const InterfacesParameters &interfaces)
  {
    for (unsigned int i = 0; i < interfaces.list.size(); ++i)
      if (const auto &uplift = interfaces.list[i].uplift; uplift.given())
        {
          const std::string place =
            "in section \"Interfaces/" + interfaces.list[i].name + "/Uplift\"";
          const FaceDistance upstream(discretization.grid,
                                      split_list(uplift.upstream_faces),
                                      "\"Upstream faces\" " + place);
          const FaceDistance downstream(discretization.grid,
                                        split_list(uplift.downstream_faces),
                                        "\"Downstream faces\" " + place);
          for (unsigned int k = 0; k < solver->points.size(); ++k)
            {
              ContactPoint &point = solver->points[k];
              if (interface_of_surface[point.surface] != i)
                continue;
              const Point<3> &x  = point_positions[k];
              const double    up = upstream(x), down = downstream(x);
              point.uplift =
                uplift.pressure(x[2], up > 0. ? up / (up + down) : 0.);
              solver->update_limits(point);
            }
        }
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
  Contact::forget_approach()
  {
    for (ContactPoint &point : solver->points)
      {
        point.history.opening =
          point.status == ContactStatus::open ? point.gap[0] : 0.;
        point.history.slip = point.largest_slip =
          std::hypot(point.gap[1], point.gap[2]);
        solver->update_limits(point);
      }
    for (ContactSurface &surface : solver->surfaces)
      surface.energy = ContactEnergy();
    total = ContactSolver::Effort();
  }


  void
  Contact::add_forces(const double factor, Vector &vector) const
  {
    const auto &owned = exchange->owned_nodes();
    for (unsigned int i = 0; i < owned.size(); ++i)
      for (unsigned int d = 0; d < 3; ++d)
        vector.local_element(3 * owned[i] + d) += factor * applied[i][d];
  }


  const std::vector<unsigned int> &
  Contact::nodes() const
  {
    return exchange->owned_nodes();
  }


  KeyedValues
  Contact::checkpoint_values()
  {
    KeyedValues values{memory_width, {}};
    point_memory.resize(solver->points.size());
    for (unsigned int k = 0; k < point_memory.size(); ++k)
      {
        const ContactPoint &point = solver->points[k];
        point_memory[k]           = {{point.force[0],
                                      point.force[1],
                                      point.force[2],
                                      point.stick_point[0],
                                      point.stick_point[1],
                                      point.history.opening,
                                      point.history.slip,
                                      point.bar_extension,
                                      point.largest_slip,
                                      static_cast<double>(point.status)}};
        values.items.emplace_back(point_keys[k], point_memory[k].data());
      }
    return values;
  }


  nlohmann::json
  Contact::save() const
  {
    nlohmann::json energies;
    for (const ContactSurface &surface : solver->surfaces)
      energies.push_back(
        sum_over_ranks(std::vector<double>{surface.energy.impact,
                                           surface.energy.friction,
                                           surface.energy.bond,
                                           surface.energy.bars,
                                           surface.energy.uplift},
                       communicator));
    const auto largest = [&](const auto value) {
      return Utilities::MPI::max(value, communicator);
    };
    return {{"energies", energies},
            {"penetration", largest(total.penetration)},
            {"residual", largest(total.residual)},
            {"sweeps", largest(total.sweeps)},
            {"all sweeps", Utilities::MPI::sum(total.all_sweeps, communicator)},
            {"clusters", Utilities::MPI::sum(total.clusters, communicator)}};
  }


  void
  Contact::load(const nlohmann::json &saved)
  {
    for (unsigned int k = 0; k < solver->points.size(); ++k)
      {
        ContactPoint      &point  = solver->points[k];
        const PointMemory &memory = point_memory[k];
        for (unsigned int d = 0; d < 3; ++d)
          point.force[d] = memory[d];
        point.stick_point[0]  = memory[3];
        point.stick_point[1]  = memory[4];
        point.history.opening = memory[5];
        point.history.slip    = memory[6];
        point.bar_extension   = memory[7];
        point.largest_slip    = memory[8];
        point.status          = static_cast<ContactStatus>(memory[9]);
        solver->update_limits(point);
      }

    // sums are taken over the ranks: the first one gets all
    for (ContactSurface &surface : solver->surfaces)
      surface.energy = {};
    total = {};
    if (Utilities::MPI::this_mpi_process(communicator) != 0)
      return;
    for (unsigned int s = 0; s < solver->surfaces.size(); ++s)
      {
        const std::vector<double> e = saved.at("energies").at(s);
        solver->surfaces[s].energy  = {e[0], e[1], e[2], e[3], e[4]};
      }
    total.penetration = saved.at("penetration");
    total.residual    = saved.at("residual");
    total.sweeps      = saved.at("sweeps");
    total.all_sweeps  = saved.at("all sweeps");
    total.clusters    = saved.at("clusters");
  }


  const ContactSolver::Effort &
  Contact::effort() const
  {
    return total;
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


  const std::vector<Point<3>> &
  Contact::positions() const
  {
    return point_positions;
  }


  const std::vector<std::uint64_t> &
  Contact::keys() const
  {
    return point_keys;
  }


  const std::vector<types::global_dof_index> &
  Contact::first_nodes() const
  {
    return first_node;
  }
} // namespace Voussoir
