#include <voussoir/constraints/interface_points.h>
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


  InterfacePoints::InterfacePoints(const Discretization       &discretization,
                                   const InterfacesParameters &interfaces,
                                   const InterfaceSurfaces    &face_sets)
    : communicator(discretization.grid.communicator())
    , names(face_sets.names())
    , interfaces(interfaces)
  {
    for (unsigned int i = 0; i < interfaces.list.size(); ++i)
      for (std::size_t s = 0; s < face_sets.of_interface[i].size(); ++s)
        {
          ContactSurface surface;
          surface.law       = interfaces.list[i].law.get();
          surface.key_depth = interfaces.list[i].key_depth;
          surface.tied      = interfaces.list[i].tied;
          surfaces.push_back(surface);
          interface_of_surface.push_back(i);
        }
    add_points(discretization);
    exchange_of_nodes.emplace(discretization, cluster_nodes);
    find_uplift(discretization);
    for (const InterfaceParameters &interface : interfaces.list)
      has_water.push_back(interface.uplift.comes_with.empty());
    for (unsigned int i = 0; i < interfaces.list.size(); ++i)
      if (interfaces.list[i].grouted_after.empty())
        join(i, std::vector<Tensor<1, 3>>(n_nodes()));

    cell_size = std::numeric_limits<double>::max();
    for (const std::string &name : names)
      discretization.grid.for_each_face(
        name, [&](const auto &cell, const unsigned int) {
          cell_size = std::min(cell_size, cell->minimum_vertex_distance());
        });
    cell_size = Utilities::MPI::min(cell_size, communicator);
  }


  void
  InterfacePoints::add_points(const Discretization &discretization)
  {
    auto clusters = find_contact_clusters(discretization, names);
    std::stable_partition(clusters.begin(),
                          clusters.end(),
                          [](const ContactCluster &cluster) {
                            return cluster.pairs.size() == 1;
                          });
    for (const ContactCluster &cluster : clusters)
      {
        std::vector<ContactPoint> added;
        for (const ContactPair &pair : cluster.pairs)
          {
            // their order in a cluster is the same on all partitions
            keys.push_back(256 * cluster.key + added.size());
            ContactPoint point;
            point.surface = pair.interface;
            point.first   = pair.first;
            point.second  = pair.second;
            point.frame   = frame_of(pair.normal);
            point.area    = pair.area;
            point.joined  = false;
            added.push_back(point);
            positions.push_back(cluster.position);
            forces_unique.push_back(cluster.pairs.size() <
                                    cluster.nodes.size());
            first_nodes.push_back(cluster.nodes[pair.first]);
          }
        add_cluster(cluster.nodes.size(), added);
        cluster_nodes.insert(cluster_nodes.end(),
                             cluster.nodes.begin(),
                             cluster.nodes.end());
      }
  }


  double
  InterfacePoints::set_delay(
    const Discretization                            &discretization,
    const std::function<double(const Grid::Cell &)> &wave_speed)
  {
    // 2 cells leave some chatter where friction is above 0.7 (see
    // doc/theory.md)
    constexpr double cells = 4.;

    // sum and number of the times of passage at the nodes of the surfaces
    Vector times(discretization.owned_dofs,
                 discretization.relevant_dofs,
                 communicator);
    std::vector<std::pair<types::global_dof_index, double>> records;
    for (const std::string &name : names)
      for (const std::string &side : {name, name + other_side})
        discretization.grid.for_each_face(
          side, [&](const auto &cell, const unsigned int) {
            const double length =
              cell->minimum_vertex_distance() / discretization.degree;
            for (const types::global_dof_index node :
                 discretization.cell_nodes(discretization.dof_cell(cell)))
              if (discretization.reproducible)
                records.emplace_back(node, length / wave_speed(cell));
              else
                {
                  times(3 * node) += length / wave_speed(cell);
                  times(3 * node + 1) += 1.;
                }
          });
    times.compress(VectorOperation::add);
    for (const auto &[node, time] : discretization.send_to_owners(records))
      {
        times.local_element(3 * node) += time;
        times.local_element(3 * node + 1) += 1.;
      }
    std::vector<Tensor<1, 3>> at_nodes(n_nodes());
    exchange().to_clusters(times, at_nodes);
    const auto mean_at = [&](const unsigned int node) {
      return at_nodes[node][0] / at_nodes[node][1];
    };
    double largest = 0.;
    for (unsigned int k = 0; k < points.size(); ++k)
      if (forces_unique[k])
        {
          ContactPoint &point = points[k];
          point.delay =
            cells * std::max(mean_at(point.first), mean_at(point.second));
          largest = std::max(largest, point.delay);
        }
    return Utilities::MPI::max(largest, communicator);
  }


  void
  InterfacePoints::find_uplift(const Discretization &discretization)
  {
    uplift.resize(points.size());
    for (unsigned int i = 0; i < interfaces.list.size(); ++i)
      if (const auto &water = interfaces.list[i].uplift; water.given())
        {
          const std::string place =
            "in section \"Interfaces/" + interfaces.list[i].name + "/Uplift\"";
          std::vector<std::string> own;
          for (unsigned int s = 0; s < names.size(); ++s)
            if (interface_of_surface[s] == i)
              own.push_back(names[s]);
          const std::vector<FaceCorners> surface =
            gather_faces(discretization.grid, own, place);
          const EdgeDistance upstream(discretization.grid,
                                      surface,
                                      split_list(water.upstream_faces),
                                      "\"Upstream faces\" " + place),
            downstream(discretization.grid,
                       surface,
                       split_list(water.downstream_faces),
                       "\"Downstream faces\" " + place);
          for (unsigned int k = 0; k < points.size(); ++k)
            {
              if (interface_of_surface[points[k].surface] != i)
                continue;
              const Point<3> &x  = positions[k];
              const double    up = upstream(x), down = downstream(x);
              uplift[k] = water.pressure(x[2], up > 0. ? up / (up + down) : 0.);
            }
        }
  }


  void
  InterfacePoints::join(const unsigned int               interface,
                        const std::vector<Tensor<1, 3>> &displacement)
  {
    const InterfaceParameters &joined = interfaces.list[interface];
    for (unsigned int s = 0; s < surfaces.size(); ++s)
      if (interface_of_surface[s] == interface)
        {
          ContactSurface &surface = surfaces[s];
          surface.bar_stiffness =
            joined.steel_ratio * joined.steel_modulus / joined.free_length;
          surface.bar_strength = joined.steel_ratio * joined.yield_stress;
        }
    for (unsigned int k = 0; k < points.size(); ++k)
      {
        ContactPoint &point = points[k];
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
        update_limits(point);
      }
    set_uplift(interface);
  }


  void
  InterfacePoints::set_uplift(const unsigned int interface)
  {
    if (!has_water[interface])
      return;
    for (unsigned int k = 0; k < points.size(); ++k)
      {
        ContactPoint &point = points[k];
        if (interface_of_surface[point.surface] == interface && point.joined)
          {
            point.uplift = uplift[k];
            update_limits(point);
          }
      }
  }


  void
  InterfacePoints::apply_uplift(const std::vector<std::string> &loads)
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
  InterfacePoints::grout(const std::vector<std::string> &loads,
                         const Vector                   &displacement)
  {
    std::vector<Tensor<1, 3>> at_nodes(n_nodes());
    exchange().to_clusters(displacement, at_nodes);
    bool joined = false;
    for (unsigned int i = 0; i < interfaces.list.size(); ++i)
      if (std::find(loads.begin(),
                    loads.end(),
                    interfaces.list[i].grouted_after) != loads.end())
        {
          join(i, at_nodes);
          joined = true;
        }
    return joined;
  }


  void
  InterfacePoints::join_all(const std::vector<bool> &water)
  {
    has_water = water;
    for (unsigned int i = 0; i < interfaces.list.size(); ++i)
      join(i, std::vector<Tensor<1, 3>>(n_nodes()));
  }


  bool
  InterfacePoints::touches(const ContactPoint &point) const
  {
    return point.joined && point.gap[0] <= 1e-6 * cell_size;
  }


  ContactExchange &
  InterfacePoints::exchange()
  {
    return *exchange_of_nodes;
  }


  const ContactExchange &
  InterfacePoints::exchange() const
  {
    return *exchange_of_nodes;
  }
} // namespace Voussoir
