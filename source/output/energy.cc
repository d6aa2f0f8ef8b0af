#include <voussoir/base/mpi.h>
#include <voussoir/output/energy.h>

namespace Voussoir
{
  using namespace dealii;

  EnergyBalance::EnergyBalance(const Discretization    &discretization,
                               const InternalForce     &internal_force,
                               const LumpedMass        &mass,
                               const Damping           &damping,
                               const NodalTerms        &terms,
                               const InitialState      &initial_state,
                               const CentralDifference &scheme)
    : discretization(discretization)
    , internal_force(internal_force)
    , mass(mass)
    , damping(damping)
    , terms(terms)
    , initial_state(initial_state)
    , scheme(scheme)
    , moved(discretization.create_vector())
    , moved_before(moved)
  {
    // what round-off makes of the static energy is no motion
    if (initial_state.force.size() > 0)
      round_off =
        1e-12 * std::abs(initial_state.displacement * initial_state.force);
  }


  void
  EnergyBalance::open(const std::string &folder,
                      const double       start_time,
                      const bool         restarted)
  {
    table.open(discretization.grid.communicator(),
               folder + "/energy.csv",
               {"kinetic [J]",
                "strain [J]",
                "memory [J]",
                "damping [J]",
                "boundary [J]",
                "material [J]",
                "input [J]",
                "constraints [J]",
                "unaccounted [J]"},
               scheme.time_step,
               start_time,
               restarted);
  }


  const EnergyTerms &
  EnergyBalance::evaluate(const State &state)
  {
    const double dt = scheme.time_step;

    moved = state.displacement;
    if (initial_state.displacement.size() > 0)
      moved -= initial_state.displacement;

    // local sums first, then one reduction
    double kinetic = 0.;
    for (unsigned int i = 0; i < state.velocity.locally_owned_size(); ++i)
      {
        const double v = state.velocity.local_element(i);
        kinetic += 0.5 * mass.mass.local_element(i) * v * v;
        moved_before.local_element(i) = moved.local_element(i) - dt * v;
      }
    kinetic += terms.kinetic_energy(state.velocity);
    std::vector<double> sums{kinetic,
                             terms.spring_energy(moved, state.velocity),
                             terms.loss_in_dashpots,
                             terms.work_of_forces + scheme.work_of_base,
                             scheme.work_of_projections,
                             scheme.loss_by_mass,
                             state.material_memory.dissipated()};
    sums = sum_over_ranks(sums, discretization.grid.communicator());

    terms_now.kinetic = sums[0];
    terms_now.strain  = internal_force.stored_energy(state.displacement,
                                                    state.material_memory,
                                                    initial_state,
                                                    moved,
                                                    moved_before) +
                       sums[1];
    terms_now.boundary    = sums[2];
    terms_now.input       = sums[3];
    terms_now.constraints = sums[4];
    terms_now.material    = sums[6];
    // of the work of contact, what its static forces do on the way
    if (initial_state.contact_force.size() > 0)
      terms_now.constraints -=
        0.5 * (initial_state.contact_force * moved +
               initial_state.contact_force * moved_before);

    // branch i is a spring D_i s K with a dashpot: stored w^T K w / (2 D_i /
    // s), lost w^T K w / (D_i tau_i) per time
    double loss_rate = 0.;
    terms_now.memory = 0.;
    for (unsigned int i = 0; i < state.memory.size(); ++i)
      if (damping.coefficients[i] > 0.)
        {
          const double work =
            internal_force.damping_work(state.memory[i],
                                        state.memory[i],
                                        state.material_memory);
          terms_now.memory += 0.5 * work / damping.coefficients[i];
          loss_rate +=
            work / (damping.coefficients[i] * damping.relaxation_times[i]);
        }
    if (damping.stiffness_coefficient > 0.)
      loss_rate += damping.stiffness_coefficient *
                   internal_force.damping_work(state.velocity,
                                               state.velocity,
                                               state.material_memory);
    const double mass_loss_before = mass_loss;
    mass_loss                     = sums[5];
    if (first)
      {
        initial = terms_now.stored();
        first   = false;
      }
    else
      terms_now.damping +=
        0.5 * (loss_rate + last_loss_rate) * (state.time - last_time) +
        mass_loss - mass_loss_before;
    last_loss_rate = loss_rate;
    last_time      = state.time;

    largest_turnover =
      std::max({largest_turnover,
                std::abs(terms_now.input + terms_now.constraints),
                terms_now.boundary,
                initial,
                round_off});
    if (largest_turnover > 0.)
      largest_error =
        std::max(largest_error,
                 std::abs(terms_now.error(initial)) / largest_turnover);
    table.write(state.time,
                {terms_now.kinetic,
                 terms_now.strain,
                 terms_now.memory,
                 terms_now.damping,
                 terms_now.boundary,
                 terms_now.material,
                 terms_now.input,
                 terms_now.constraints,
                 terms_now.error(initial)});
    table.flush();
    return terms_now;
  }


  const EnergyTerms &
  EnergyBalance::latest() const
  {
    return terms_now;
  }


  double
  EnergyBalance::relative_error() const
  {
    return largest_turnover > 0. ?
             std::abs(terms_now.error(initial)) / largest_turnover :
             0.;
  }


  std::string
  EnergyBalance::alarm() const
  {
    if (!std::isfinite(terms_now.stored()))
      return "the motion is no longer finite (NaN or infinite)";
    if (terms_now.stored() > 100. * (largest_turnover + 1e-9))
      return "the stored energy has grown to a hundred times all energy that "
             "came in";
    return "";
  }


  nlohmann::json
  EnergyBalance::summary() const
  {
    return {{"kinetic [J]", terms_now.kinetic},
            {"strain [J]", terms_now.strain},
            {"damping memory [J]", terms_now.memory},
            {"lost in damping [J]", terms_now.damping},
            {"gone through the boundary [J]", terms_now.boundary},
            {"lost to cracks and plastic flow [J]", terms_now.material},
            {"input [J]", terms_now.input},
            {"work of constraints [J]", terms_now.constraints},
            {"initial [J]", initial},
            {"unaccounted, share of the input", relative_error()},
            {"largest unaccounted share", largest_error}};
  }


  nlohmann::json
  EnergyBalance::save() const
  {
    return {{"damping", terms_now.damping},
            {"initial", initial},
            {"largest_turnover", largest_turnover},
            {"largest_error", largest_error},
            {"last_time", last_time},
            {"last_loss_rate", last_loss_rate},
            {"mass_loss", mass_loss}};
  }


  void
  EnergyBalance::load(const nlohmann::json &saved)
  {
    terms_now.damping = saved.at("damping");
    initial           = saved.at("initial");
    largest_turnover  = saved.at("largest_turnover");
    largest_error     = saved.at("largest_error");
    last_time         = saved.at("last_time");
    last_loss_rate    = saved.at("last_loss_rate");
    mass_loss         = saved.at("mass_loss");
    first             = false;
  }
} // namespace Voussoir
