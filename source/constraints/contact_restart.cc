// State of contact in a checkpoint.

#include <voussoir/base/mpi.h>
#include <voussoir/constraints/contact.h>

namespace Voussoir
{
  using namespace dealii;

  KeyedValues
  Contact::checkpoint_values()
  {
    KeyedValues values{memory_width, {}};
    point_memory.resize(interfaces.points.size());
    for (unsigned int k = 0; k < point_memory.size(); ++k)
      {
        const ContactPoint &point = interfaces.points[k];
        point_memory[k]           = {
                    {point.force[0],       point.force[1],
                     point.force[2],       point.stick_point[0],
                     point.stick_point[1], point.history.opening,
                     point.history.slip,   point.bar_extension,
                     point.largest_slip,   point.initial_gap[0],
                     point.initial_gap[1], point.initial_gap[2],
                     point.mean_pressure,  static_cast<double>(point.status),
                     point.gap[0],         point.gap[1],
                     point.gap[2],         point.velocity[0],
                     point.velocity[1],    point.velocity[2],
                     point.history.tip}};
        values.items.emplace_back(interfaces.keys[k], point_memory[k].data());
      }
    return values;
  }


  std::vector<double *>
  Contact::energies()
  {
    std::vector<double *> list;
    for (ContactSurface &surface : interfaces.surfaces)
      {
        ContactEnergy &energy = surface.energy;
        list.insert(list.end(),
                    {&energy.impact,
                     &energy.friction,
                     &energy.bond,
                     &energy.bars,
                     &energy.uplift});
      }
    return list;
  }


  nlohmann::json
  Contact::save() const
  {
    nlohmann::json energies;
    for (const ContactSurface &surface : interfaces.surfaces)
      energies.push_back(
        sum_over_ranks(std::vector<double>{surface.energy.impact,
                                           surface.energy.friction,
                                           surface.energy.bond,
                                           surface.energy.bars,
                                           surface.energy.uplift},
                       interfaces.communicator));
    const ContactSolver::Effort made = effort();
    return {{"energies", energies},
            {"water", interfaces.has_water},
            {"penetration", made.penetration},
            {"residual", made.residual},
            {"sweeps", made.sweeps},
            {"all sweeps", made.all_sweeps},
            {"clusters", made.clusters},
            {"paths", made.paths},
            {"unsolved", made.unsolved}};
  }


  void
  Contact::load(const nlohmann::json &saved)
  {
    interfaces.join_all(saved.at("water"));
    for (unsigned int k = 0; k < interfaces.points.size(); ++k)
      {
        ContactPoint      &point  = interfaces.points[k];
        const PointMemory &memory = point_memory[k];
        for (unsigned int d = 0; d < 3; ++d)
          {
            point.force[d]       = memory[d];
            point.initial_gap[d] = memory[9 + d];
          }
        point.stick_point[0]  = memory[3];
        point.stick_point[1]  = memory[4];
        point.history.opening = memory[5];
        point.history.slip    = memory[6];
        point.history.tip     = memory[20];
        point.bar_extension   = memory[7];
        point.largest_slip    = memory[8];
        point.status          = static_cast<ContactStatus>(memory[13]);
        point.mean_pressure   = memory[12];
        interfaces.update_limits(point);
      }

    // sums are taken over the ranks: the first rank gets all of each sum
    for (ContactSurface &surface : interfaces.surfaces)
      surface.energy = {};
    total = {};
    if (Utilities::MPI::this_mpi_process(interfaces.communicator) != 0)
      return;
    for (unsigned int s = 0; s < interfaces.surfaces.size(); ++s)
      {
        const std::vector<double> e   = saved.at("energies").at(s);
        interfaces.surfaces[s].energy = {e[0], e[1], e[2], e[3], e[4]};
      }
    total.penetration = saved.at("penetration");
    total.residual    = saved.at("residual");
    total.sweeps      = saved.at("sweeps");
    total.all_sweeps  = saved.at("all sweeps");
    total.clusters    = saved.at("clusters");
    total.paths       = saved.at("paths");
    total.unsolved    = saved.at("unsolved");
  }


  void
  Contact::resume()
  {
    for (unsigned int k = 0; k < interfaces.points.size(); ++k)
      {
        ContactPoint &point = interfaces.points[k];
        for (unsigned int d = 0; d < 3; ++d)
          {
            point.gap[d]      = point_memory[k][14 + d];
            point.velocity[d] = point_memory[k][17 + d];
          }
        interfaces.update_limits(point);
      }
  }
} // namespace Voussoir
