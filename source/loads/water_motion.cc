#include <voussoir/loads/water_motion.h>

namespace Voussoir
{
  using namespace dealii;

  WaterMotion::WaterMotion(const Reservoir &reservoir,
                           const RigidBase &base,
                           const double     time_step)
    : reservoir(reservoir)
    , pressure(reservoir.space.create_vector())
    , impulse(pressure)
    , base(base)
    , time_step(time_step)
    , last_wall_pressure(reservoir.wall_nodes.size())
    , last_floor_pressure(reservoir.floor_nodes.size())
    , last_lossy_pressure(reservoir.lossy_nodes.size())
    , keep(pressure)
    , push(pressure)
    , stiffness(pressure)
    , wall_pressure(reservoir.create_wall_vector())
    , flux(wall_pressure)
  {
    for (unsigned int i = 0; i < pressure.locally_owned_size(); ++i)
      {
        const double gain =
          time_step * reservoir.inverse_storage.local_element(i);
        const double damping = 0.5 * gain * reservoir.dashpots.local_element(i);
        push.local_element(i) = gain / (1. + damping);
        keep.local_element(i) = (1. - damping) / (1. + damping);
      }
    if (reservoir.end)
      {
        end.emplace(*reservoir.end, time_step);
        last_end_pressure.resize(reservoir.end->nodes.size());
      }
  }


  void
  WaterMotion::add_forces(const double, NodalForces &forces)
  {
    for (const Reservoir::WallNode &node : reservoir.wall_nodes)
      wall_pressure.local_element(node.water) =
        pressure.local_element(node.water);
    wall_pressure.update_ghost_values();
    for (const Reservoir::Pair &pair : reservoir.pairs)
      forces.add(pair.node,
                 wall_pressure.local_element(pair.water) * pair.area);
  }


  void
  WaterMotion::advance(const Vector       &velocity,
                       const Tensor<1, 3> &base_velocity)
  {
    for (unsigned int i = 0; i < reservoir.wall_nodes.size(); ++i)
      {
        flux.local_element(reservoir.wall_nodes[i].water) = 0.;
        last_wall_pressure[i] =
          pressure.local_element(reservoir.wall_nodes[i].water);
      }
    for (unsigned int i = 0; i < reservoir.lossy_nodes.size(); ++i)
      last_lossy_pressure[i] = pressure.local_element(reservoir.lossy_nodes[i]);
    for (unsigned int i = 0; i < last_end_pressure.size(); ++i)
      {
        const unsigned int node  = reservoir.end->nodes[i].water;
        last_end_pressure[i]     = pressure.local_element(node);
        flux.local_element(node) = 0.;
      }
    for (unsigned int i = 0; i < reservoir.floor_nodes.size(); ++i)
      {
        const unsigned int node  = reservoir.floor_nodes[i].water;
        last_floor_pressure[i]   = pressure.local_element(node);
        flux.local_element(node) = 0.;
      }
    reservoir.gather_flux(flux, velocity);

    // the work needs the flux without that of the base
    std::vector<double> solid_flux(reservoir.wall_nodes.size());
    for (unsigned int i = 0; i < reservoir.wall_nodes.size(); ++i)
      {
        solid_flux[i] = flux.local_element(reservoir.wall_nodes[i].water);
        flux.local_element(reservoir.wall_nodes[i].water) +=
          reservoir.wall_nodes[i].area * base_velocity;
      }
    for (const Reservoir::WallNode &node : reservoir.floor_nodes)
      flux.local_element(node.water) += node.area * base_velocity;
    if (end)
      end->advance(pressure, flux);

    double       *p = pressure.begin(), *I = impulse.begin();
    double       *f = stiffness.begin();
    const double *q = flux.begin(), *a = keep.begin(), *b = push.begin();
    reservoir.space.sweep(
      stiffness,
      impulse,
      [&](const unsigned int begin, const unsigned int end) {
#pragma GCC ivdep
        for (unsigned int i = begin; i < end; ++i)
          {
            I[i] += time_step * p[i];
            f[i] = 0.;
          }
      },
      [&](const unsigned int begin, const unsigned int end) {
        const double mobility = 1. / reservoir.density;
#pragma GCC ivdep
        for (unsigned int i = begin; i < end; ++i)
          p[i] = a[i] * p[i] - b[i] * (mobility * f[i] + q[i]);
      });

    for (unsigned int i = 0; i < reservoir.wall_nodes.size(); ++i)
      {
        const double mean =
          0.5 * (last_wall_pressure[i] + p[reservoir.wall_nodes[i].water]);
        work_on_solid += time_step * mean * solid_flux[i];
        work_on_base +=
          time_step * mean * (reservoir.wall_nodes[i].area * base_velocity);
      }
    for (unsigned int i = 0; i < reservoir.floor_nodes.size(); ++i)
      work_on_base +=
        0.5 * time_step *
        (last_floor_pressure[i] + p[reservoir.floor_nodes[i].water]) *
        (reservoir.floor_nodes[i].area * base_velocity);
    for (unsigned int i = 0; i < reservoir.lossy_nodes.size(); ++i)
      {
        const double mean =
          0.5 * (last_lossy_pressure[i] + p[reservoir.lossy_nodes[i]]);
        loss += time_step *
                reservoir.dashpots.local_element(reservoir.lossy_nodes[i]) *
                mean * mean;
      }
    for (unsigned int i = 0; i < last_end_pressure.size(); ++i)
      loss += 0.5 * time_step * end->added[i] *
              (last_end_pressure[i] + p[reservoir.end->nodes[i].water]);
  }


  double
  WaterMotion::stored_energy() const
  {
    // p M p / (2 rho c^2) + I- K I+ / (2 rho)
    Vector next(impulse), force(impulse);
    next.add(time_step, pressure);
    force = 0.;
    reservoir.space.sweep(force, next, {}, {});
    Vector squares(pressure);
    squares.scale(pressure);
    return 0.5 * reservoir.compressibility *
             (squares * reservoir.space.volumes) +
           0.5 / reservoir.density * (impulse * force);
  }


  double
  WaterMotion::work_ahead(const Vector &velocity) const
  {
    Vector wall = reservoir.create_wall_vector();
    reservoir.gather_flux(wall, velocity);
    double sum = 0.;
    for (const Reservoir::WallNode &node : reservoir.wall_nodes)
      sum +=
        pressure.local_element(node.water) * wall.local_element(node.water);
    return 0.5 * time_step *
           Utilities::MPI::sum(sum, reservoir.space.grid.communicator());
  }


  void
  WaterMotion::end_step(const State &state)
  {
    advance(state.velocity, base.velocity(state.time - 0.5 * time_step));
  }
} // namespace Voussoir
