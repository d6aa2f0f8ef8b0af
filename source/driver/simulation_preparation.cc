// What a simulation needs before its first step: loads, reservoir, static
// state, modes, ground motion, and the time step.

#include <voussoir/base/error.h>
#include <voussoir/driver/simulation.h>
#include <voussoir/output/field_writer.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  unsigned int
  Simulation::material_of(const Grid::Cell &cell) const
  {
    return coarse_materials[Grid::coarse_cell(cell)];
  }


  bool
  Simulation::rigid_base() const
  {
    return parameters.ground_motion.type != "none" &&
           parameters.wave.enters_through == "rigid base";
  }


  std::array<Tensor<1, 3>, 3>
  Simulation::base_motion(const double time) const
  {
    std::array<Tensor<1, 3>, 3> motion;
    for (unsigned int d = 0; d < 3; ++d)
      if (base_signals[d])
        {
          motion[0][d] = base_signals[d]->displacement(time);
          motion[1][d] = base_signals[d]->velocity(time);
          motion[2][d] = base_signals[d]->acceleration(time);
        }
    return motion;
  }


  void
  Simulation::prepare_loads()
  {
    const LoadedModel     loaded{discretization,
                             materials,
                             [this](const Grid::Cell &cell) {
                               return material_of(cell);
                             },
                             parameters.file};
    std::set<std::string> staged;
    for (const auto &stage : parameters.static_state.stage_names())
      staged.insert(stage.begin(), stage.end());
    for (const auto &[name, load] : parameters.loads.objects)
      {
        load->prepare(loaded, terms, "Loads/" + name);
        if (staged.count(name) == 0)
          running_loads.push_back(load.get());
      }
    prepare_reservoir();
    for (const auto &[name, projection] : parameters.projections.objects)
      {
        projection->prepare(discretization,
                            mass,
                            parameters.file,
                            "Constraints/" + name);
        projections.push_back(projection.get());
      }
    if (!parameters.interfaces.list.empty())
      {
        contact =
          std::make_unique<Contact>(discretization, parameters.interfaces);
        projections.push_back(contact.get());
      }
  }


  void
  Simulation::prepare_reservoir()
  {
    const ReservoirParameters &water = parameters.reservoir;
    if (water.model == "added mass")
      log.line("Reservoir: added mass of ",
               add_westergaard_mass(
                 discretization, water.added_mass, water.density, terms),
               " kg over all facets");
    if (water.model == "compressible")
      {
        reservoir = std::make_unique<Reservoir>(
          water_mesh, parameters.grid, water, discretization, terms);
        double surface = std::numeric_limits<double>::lowest();
        for (const Point<3> &node : reservoir->space.node_positions)
          surface = std::max(surface, node[2]);
        log.line("Reservoir: ",
                 reservoir->space.dof_handler.n_dofs(),
                 " unknowns of compressible water up to z = ",
                 Utilities::MPI::max(surface, grid.communicator()),
                 " m, ",
                 reservoir->space.grid.describe_balance(),
                 ", largest step ",
                 reservoir->stable_step(),
                 " s");
      }
  }


  InitialState
  Simulation::find_initial_state()
  {
    if (parameters.static_state.stage_names().empty() || options.validate)
      {
        InitialState state;
        state.material_memory = internal_force.new_memory();
        return state;
      }
    TimerOutput::Scope scope(timer, "static state");
    return find_static_state({discretization,
                              internal_force,
                              materials,
                              [this](const Grid::Cell &cell) {
                                return material_of(cell);
                              },
                              parameters.boundaries,
                              mass,
                              terms,
                              contact.get()},
                             parameters.static_state,
                             parameters.load_list(),
                             log,
                             static_summary);
  }


  Modes
  Simulation::find_natural_modes()
  {
    if (parameters.modes.number == 0 || options.validate)
      return {};
    TimerOutput::Scope scope(timer, "modes");
    Modes              found =
      find_modes({discretization,
                  internal_force,
                  parameters.material_names(),
                  materials,
                  [this](const Grid::Cell &cell) { return material_of(cell); },
                  parameters.boundaries,
                  terms},
                 parameters.modes,
                 log);
    damping.adapt_to_modes(found.frequencies());
    return found;
  }


  void
  Simulation::write_modes()
  {
    if (modes.list.empty())
      return;
    std::vector<NodalField> fields;
    for (unsigned int j = 0; j < modes.list.size(); ++j)
      {
        std::ostringstream name;
        name << std::setprecision(4) << "mode " << j + 1 << " ("
             << modes.list[j].frequency << " Hz)";
        fields.push_back({&modes.list[j].shape, {name.str()}});
      }
    write_fields(model, fields, nullptr, "modes", 0.);
  }


  void
  Simulation::prepare_ground_motion()
  {
    if (parameters.ground_motion.type == "none")
      return;
    GroundMotionSignals motion =
      parameters.ground_motion.build(parameters.file.folder());
    log(parameters.ground_motion.summary(motion, parameters.time.end_time));
    if (rigid_base())
      base_signals = std::move(motion);
    else
      boundary.set_free_field(
        make_free_field(boundary,
                        discretization,
                        materials,
                        parameters.discretization.quadrature,
                        damping,
                        parameters.wave,
                        parameters.ground_motion.given_at,
                        std::move(motion),
                        parameters.time.scheme == "paper",
                        time_step,
                        parameters.time.end_time));
  }


  double
  Simulation::find_largest_step()
  {
    TimerOutput::Scope  scope(timer, "stable step");
    std::ostringstream  text;
    std::vector<double> density;
    for (const Material *material : materials)
      density.push_back(material->inertial_density());
    const ElementSteps elements(discretization, internal_force, density);
    elements.print(text);
    log(text.str());

    const bool   paper = parameters.time.scheme == "paper";
    const double alpha = damping.mass_coefficient;
    StepLimits   limits;
    limits.stiffening = [&](const double dt) { return damping.stiffening(dt); };
    limits.add_diagonal =
      [&](Vector &force, const Vector &displacement, const double dt) {
        terms.add_to(force, displacement, paper ? 2. / dt : 0.);
        if (paper && alpha > 0.)
          for (unsigned int i = 0; i < force.locally_owned_size(); ++i)
            force.local_element(i) += 2. / dt * alpha *
                                      mass.mass.local_element(i) *
                                      displacement.local_element(i);
        if (reservoir)
          reservoir->add_coupling(force, displacement, dt);
      };
    undamped_step =
      damping.stiffening(1.) > 0. ?
        stable_step(discretization,
                    internal_force,
                    mass,
                    {[](const double) { return 0.; },
                     [](Vector &, const Vector &, const double) {}}) :
        0.;
    const double step =
      stable_step(discretization, internal_force, mass, limits);
    // the bound on the coupling holds up to this share of the water's own limit
    return reservoir ? std::min(step, 0.95 * reservoir->stable_step()) : step;
  }


  double
  Simulation::choose_time_step()
  {
    if (options.restart)
      return Checkpoint::read_header(folder + "/checkpoint").at("time step");
    const double given = parameters.time.time_step;
    if (given > largest_step)
      {
        std::ostringstream text;
        text << std::setprecision(3) << "\"Time step\" in section \"Time\" is "
             << given << " s, but the largest stable one is " << largest_step
             << " s; choose a smaller one, or 0 for the automatic choice.";
        throw UserError(text.str());
      }
    return given > 0. ? given : parameters.time.safety_factor * largest_step;
  }


  unsigned long long
  Simulation::n_steps() const
  {
    return std::ceil(parameters.time.end_time / time_step - 1e-9);
  }
} // namespace Voussoir
