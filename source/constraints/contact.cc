#include <voussoir/base/mpi.h>
#include <voussoir/constraints/contact.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;


  Contact::Contact(const Discretization       &discretization,
                   const InterfacesParameters &parameters,
                   const InterfaceSurfaces    &surfaces)
    : exact_sums(discretization.reproducible)
    , interfaces(discretization, parameters, surfaces)
    , displacement(interfaces.n_nodes())
    , force(displacement.size())
    , applied(interfaces.exchange().owned_nodes().size())
    , last_velocity(applied.size())
  {}


  InterfacePoints &
  Contact::points_of_interfaces()
  {
    return interfaces;
  }


  double
  Contact::set_delay(
    const Discretization                            &discretization,
    const std::function<double(const Grid::Cell &)> &wave_speed)
  {
    return interfaces.set_delay(discretization, wave_speed);
  }


  void
  Contact::prepare_tips(const Solid &solid)
  {
    if (std::any_of(interfaces.surfaces.begin(),
                    interfaces.surfaces.end(),
                    [](const ContactSurface &surface) {
                      return surface.law->grows_from_tips();
                    }))
      tips.emplace(solid, interfaces);
  }


  BondTips *
  Contact::bond_tips()
  {
    return tips ? &*tips : nullptr;
  }


  void
  Contact::begin_earthquake()
  {
    if (tips)
      tips->begin_earthquake();
  }


  void
  Contact::apply_uplift(const std::vector<std::string> &loads)
  {
    interfaces.apply_uplift(loads);
  }


  bool
  Contact::grout(const std::vector<std::string> &loads,
                 const Vector                   &at_displacement)
  {
    return interfaces.grout(loads, at_displacement);
  }


  void
  Contact::prepare_step(const InverseMass &inverse_mass, const double time_step)
  {
    const auto &owned = interfaces.exchange().owned_nodes();
    compliance.assign(owned.size(), -1.);
    full_compliance.resize(owned.size());
    std::vector<Tensor<2, 3>> owned_inverse(owned.size());
    for (unsigned int i = 0; i < owned.size(); ++i)
      {
        owned_inverse[i]   = inverse_mass(owned[i]);
        full_compliance[i] = time_step * time_step * owned_inverse[i];
        if (full_compliance[i] ==
            full_compliance[i][0][0] * Tensor<2, 3>(unit_symmetric_tensor<3>()))
          compliance[i] = full_compliance[i][0][0];
      }

    // row by row to the ranks of the clusters
    std::vector<Tensor<2, 3>> at_clusters(displacement.size());
    for (unsigned int row = 0; row < 3; ++row)
      {
        std::vector<Tensor<1, 3>> values(owned.size());
        for (unsigned int i = 0; i < owned.size(); ++i)
          values[i] = owned_inverse[i][row];
        interfaces.exchange().to_clusters(values, displacement);
        for (unsigned int i = 0; i < displacement.size(); ++i)
          at_clusters[i][row] = displacement[i];
      }
    solver.prepare_step(interfaces, at_clusters, time_step);

    // the bars are springs that the stable time step does not include
    double share = 0.;
    for (unsigned int k = 0; k < interfaces.points.size(); ++k)
      share = std::max(share, solver.bar_share_of_stable_step(interfaces, k));
    if (Utilities::MPI::max(share, interfaces.communicator) > 0.1)
      throw UserError("The bars across an interface are too stiff for the time "
                      "step; choose a larger \"Free length\" in its section "
                      "under \"Interfaces\", or a smaller \"Safety factor\" in "
                      "section \"Time\".");
  }


  void
  Contact::start(const State &state)
  {
    std::vector<Tensor<1, 3>> velocity(displacement.size());
    interfaces.exchange().to_clusters(state.velocity, velocity);
    interfaces.exchange().to_clusters(state.displacement, displacement);
    interfaces.start(displacement, velocity);
    const auto &owned = interfaces.exchange().owned_nodes();
    for (unsigned int i = 0; i < owned.size(); ++i)
      for (unsigned int d = 0; d < 3; ++d)
        last_velocity[i][d] = state.velocity.local_element(3 * owned[i] + d);
  }


  Projection::Result
  Contact::project(State &state, const double time_step)
  {
    const auto start = std::chrono::steady_clock::now();
    interfaces.exchange().to_clusters(state.displacement, displacement);
    const auto effort = solver.solve(interfaces, displacement, force);
    interfaces.exchange().to_owners(force, applied);

    total.penetration = std::max(total.penetration, effort.penetration);
    total.residual    = std::max(total.residual, effort.residual);
    total.sweeps      = std::max(total.sweeps, effort.sweeps);
    total.all_sweeps += effort.all_sweeps;
    total.clusters += effort.clusters;
    total.paths += effort.paths;
    total.unsolved += effort.unsolved;

    Result result;
    result.work            = Sum(exact_sums);
    result.violation       = effort.penetration;
    const double frequency = 1. / time_step;
    const auto  &owned     = interfaces.exchange().owned_nodes();
    for (unsigned int i = 0; i < owned.size(); ++i)
      {
        double            *u      = state.displacement.begin() + 3 * owned[i];
        double            *v      = state.velocity.begin() + 3 * owned[i];
        const bool         simple = compliance[i] >= 0.;
        const Tensor<1, 3> motion =
          simple ? compliance[i] * applied[i] : full_compliance[i] * applied[i];
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double momentum = time_step * applied[i][d];
            u[d] += motion[d];
            v[d] += motion[d] * frequency;
            // a support takes the momentum on a fixed node
            if (simple ? compliance[i] > 0. : full_compliance[i][d][d] > 0.)
              {
                result.impulse[d] += momentum;
                result.work += momentum * 0.5 * (v[d] + last_velocity[i][d]);
              }
            last_velocity[i][d] = v[d];
          }
      }
    if (tips)
      tips->update(state.step, interfaces);
    wall_time += std::chrono::steady_clock::now() - start;
    return result;
  }


  void
  Contact::begin_approach()
  {
    before_approach.clear();
    for (const ContactPoint &point : interfaces.points)
      before_approach.push_back({point.history,
                                 point.stick_point,
                                 point.bar_extension,
                                 point.largest_slip});
  }


  void
  Contact::forget_approach()
  {
    for (unsigned int k = 0; k < interfaces.points.size(); ++k)
      {
        ContactPoint &point  = interfaces.points[k];
        const Slid   &before = before_approach[k];
        point.history =
          point.history_since(before.history,
                              interfaces.surfaces[point.surface]
                                  .law->strength(before.history)
                                  .bond > 0.,
                              (point.stick_point - before.stick_point).norm());
        point.largest_slip =
          std::max(before.largest_slip, std::hypot(point.gap[1], point.gap[2]));
        point.bar_extension = before.bar_extension;
        interfaces.yield_bars(point);
        interfaces.update_limits(point);
      }
    for (ContactSurface &surface : interfaces.surfaces)
      surface.energy = ContactEnergy();
    total     = ContactSolver::Effort();
    wall_time = {};
  }


  void
  Contact::add_forces(const double factor, Vector &vector) const
  {
    interfaces.exchange().add(vector, factor, applied);
  }


  const std::vector<unsigned int> &
  Contact::nodes() const
  {
    return interfaces.exchange().owned_nodes();
  }


  ContactSolver::Effort
  Contact::effort() const
  {
    ContactSolver::Effort result;
    for (const auto largest : {&ContactSolver::Effort::penetration,
                               &ContactSolver::Effort::residual})
      result.*largest =
        Utilities::MPI::max(total.*largest, interfaces.communicator);
    result.sweeps = Utilities::MPI::max(total.sweeps, interfaces.communicator);
    for (const auto sum : {&ContactSolver::Effort::all_sweeps,
                           &ContactSolver::Effort::clusters,
                           &ContactSolver::Effort::paths,
                           &ContactSolver::Effort::unsolved})
      result.*sum = Utilities::MPI::sum(total.*sum, interfaces.communicator);
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
    return interfaces.names;
  }


  const std::vector<ContactSurface> &
  Contact::surfaces() const
  {
    return interfaces.surfaces;
  }


  const std::vector<ContactPoint> &
  Contact::points() const
  {
    return interfaces.points;
  }


  void
  Contact::set_points(const std::vector<ContactPoint> &points)
  {
    interfaces.points = points;
  }


  const std::vector<Point<3>> &
  Contact::positions() const
  {
    return interfaces.positions;
  }


  bool
  Contact::touches(const ContactPoint &point) const
  {
    return interfaces.touches(point);
  }


  double
  Contact::cell_size() const
  {
    return interfaces.cell_size;
  }


  const std::vector<std::uint64_t> &
  Contact::keys() const
  {
    return interfaces.keys;
  }


  const std::vector<types::global_dof_index> &
  Contact::cluster_nodes() const
  {
    return interfaces.cluster_nodes;
  }


  const std::vector<types::global_dof_index> &
  Contact::first_nodes() const
  {
    return interfaces.first_nodes;
  }
} // namespace Voussoir
