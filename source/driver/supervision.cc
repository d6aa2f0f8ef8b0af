#include <voussoir/base/text.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/driver/supervision.h>
#include <voussoir/driver/verdict_tables.h>
#include <voussoir/output/field_writer.h>
#include <voussoir/output/material_memory.h>

#include <algorithm>
#include <iomanip>
#include <tuple>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // interval of checks of cracks and slips [s]
    constexpr double check_interval = 0.1;
  } // namespace


  Supervision::Supervision(const ObservedRun   &run,
                           const EnergyBalance &energy,
                           const double         energy_limit,
                           const double         lowered_strength)
    : run(run)
    , energy(energy)
    , energy_limit(energy_limit)
    , lowered_strength(lowered_strength)
    , has_memory(run.solid.internal_force.has_memory())
    , checks(check_interval, run.time_step)
  {}


  std::string
  Supervision::check_energy(const State &state)
  {
    const std::string alarm = energy.alarm(energy_limit);
    if (!alarm.empty())
      return alarm;
    // losses by damping between two evaluations are known to a per cent or two
    const bool is_large =
      energy.relative_error() > 0.01 || energy.error_of_losses() > 0.03;
    if (is_large && !warned_of_energy)
      {
        std::ostringstream text;
        text << std::setprecision(3) << "from t = " << state.time
             << " s on the energy-balance error is large: "
             << 100. * energy.relative_error() << " % of the energy input, "
             << 100. * energy.error_of_losses()
             << " % of the losses by damping, cracks, friction and impacts";
        warned_of_energy = true;
        run.log.warn(text.str());
      }
    keep(state);
    return "";
  }


  void
  Supervision::keep(const State &state)
  {
    const auto keep = [](const Vector &vector, Motion::Values &values) {
      values.assign(vector.begin(), vector.end());
    };
    keep(state.displacement, last_good.displacement);
    keep(state.velocity, last_good.velocity);
    last_good.time = state.time;
    if (has_memory) // the internal variables belong to a later state
      return;
    last_good.memory.resize(state.memory.size());
    for (unsigned int i = 0; i < state.memory.size(); ++i)
      keep(state.memory[i], last_good.memory[i]);
  }


  void
  Supervision::check_motion(const State &state, const bool at_end)
  {
    if (!at_end && !checks.due(state.step))
      return;
    check_cracks(state.time);
    check_slips(state.time);
  }


  void
  Supervision::check_cracks(const double time)
  {
    if (warned_of_cracks || !has_memory)
      return;
    const WidestCrack widest = widest_crack(run);
    warned_of_cracks         = widest.share > widest_crack_share;
    if (!warned_of_cracks)
      return;
    std::ostringstream text;
    text << std::setprecision(3) << "at t = " << time
         << " s a crack is open by " << 1e3 * widest.opening << " mm, "
         << 100. * widest.share
         << " % of its cell: cracks have detached a block from the rest; ";
    if (lowered_strength > most_lowered)
      text << "neither its detachment nor its motion afterwards is a reliable "
              "result, as long cells lower the strength by "
           << lowered_strength << " %";
    else
      text << "its detachment is a reliable result, its motion afterwards is "
              "not";
    run.log.warn(text.str());
  }


  void
  Supervision::check_slips(const double time)
  {
    if (warned_of_slips || run.contact == nullptr)
      return;
    double       farthest = 0.;
    unsigned int surface  = 0;
    for (const ContactPoint &point : run.contact->points())
      {
        const double slip = std::hypot(point.gap[1], point.gap[2]);
        if (point.joined && slip > farthest)
          {
            farthest = slip;
            surface  = point.surface;
          }
      }
    const auto all =
      Utilities::MPI::all_gather(run.log.communicator(),
                                 std::make_pair(farthest, surface));
    std::tie(farthest, surface) = *std::max_element(all.begin(), all.end());
    warned_of_slips             = farthest > 0.5 * run.contact->cell_size();
    if (!warned_of_slips)
      return;
    std::ostringstream text;
    text << std::setprecision(3) << "at t = " << time << " s \""
         << run.contact->surface_names()[surface] << "\" has slipped by "
         << farthest
         << " m, more than half a cell of the interfaces: nodes still act on "
            "those opposite at the start; that it slides is a reliable result, "
            "where it comes to rest is not";
    run.log.warn(text.str());
  }


  void
  Supervision::check_contact() const
  {
    if (run.contact == nullptr)
      return;
    const ContactSolver::Effort effort = run.contact->effort();
    if (effort.unsolved == 0)
      return;
    std::ostringstream text;
    text << std::setprecision(3) << "no solution was found for the contact of "
         << counted(effort.unsolved, "cluster of nodes", "clusters of nodes")
         << ": gaps deviate from the laws of the interfaces there by up to "
         << 100. * effort.residual
         << " % of the motion in a step; compare with a run with a smaller "
            "\"Safety factor\" in section \"Time\"";
    run.log.warn(text.str());
  }


  std::string
  Supervision::draw_last_good() const
  {
    const auto vector_of = [&](const Motion::Values &values) {
      Vector vector = run.solid.discretization.create_vector();
      std::copy(values.begin(), values.end(), vector.begin());
      return vector;
    };
    State state;
    state.displacement = vector_of(last_good.displacement);
    state.velocity     = vector_of(last_good.velocity);
    for (const Motion::Values &values : last_good.memory)
      state.memory.push_back(vector_of(values));
    return write_fields(run,
                        {{&state.displacement, {"displacement"}},
                         {&state.velocity, {"velocity"}}},
                        has_memory ? nullptr : &state,
                        "last_good",
                        last_good.time);
  }
} // namespace Voussoir
