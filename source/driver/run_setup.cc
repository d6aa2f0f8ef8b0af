#include <voussoir/base/error.h>
#include <voussoir/base/version.h>
#include <voussoir/driver/rest_state.h>
#include <voussoir/driver/run_setup.h>
#include <voussoir/mesh/mesh_quality.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // A component of a node has one prescribed motion.
    void
    refuse_contradictions(const NamedObjects<Projection>::List &constraints,
                          const MPI_Comm                        communicator)
    {
      std::map<std::pair<unsigned int, unsigned int>, unsigned int> first;
      unsigned int                                                  found = 0;
      for (unsigned int i = 0; i < constraints.size(); ++i)
        for (unsigned int d = 0; d < 3; ++d)
          if (constraints[i].second->prescribed_components()[d])
            for (const unsigned int node : constraints[i].second->nodes())
              if (const auto other = first.emplace(std::make_pair(node, d), i);
                  !other.second)
                found = std::max<unsigned int>(
                  found,
                  1 + d + 3 * (i + constraints.size() * other.first->second));
      found = Utilities::MPI::max(found, communicator);
      if (found == 0)
        return;
      const unsigned int pair = (found - 1) / 3;
      throw UserError(
        "The constraints \"" + constraints[pair / constraints.size()].first +
        "\" and \"" + constraints[pair % constraints.size()].first +
        "\" both prescribe the component " + "xyz"[(found - 1) % 3] +
        " of the same nodes; leave it out of one of them by "
        "\"Components\", or name other faces.");
    }


    NamedObjects<Projection>::List
    made_constraints(const Model &model)
    {
      const Case &parameters = model.parameters;
      auto        list       = parameters.projections.make(parameters.file);
      for (auto &[name, constraint] : list)
        constraint->prepare(model.solid.discretization,
                            model.solid.mass,
                            parameters.file,
                            "Constraints/" + name);
      refuse_contradictions(list, model.grid.communicator());
      return list;
    }


    /** Before the modes are known that damping goes by there is none, which
     *  allows for the longest step. */
    Damping
    damping_by(const Model &model,
               const Modes &modes,
               const double undamped_limit = 0.)
    {
      DampingParameters parameters = model.parameters.damping;
      if (!parameters.modes.empty() && modes.list.empty())
        parameters.model = DampingModel::none;
      return Damping(parameters, modes.frequencies(), undamped_limit);
    }


    InternalForce
    internal_force_under(const Damping &damping, const Model &model)
    {
      std::vector<double> factors;
      for (const Material *material : model.solid.materials)
        factors.push_back(damping.stiffness_scale(material->damping_factor()));
      return model.solid.internal_force.with(factors);
    }


    double
    undamped_limit_of(const Model         &model,
                      const InternalForce &internal_force,
                      const Damping       &damping)
    {
      return internal_force.has_memory() || damping.stiffening(1.) > 0. ?
               undamped_step(model, internal_force) :
               0.;
    }


    nlohmann::json
    summary_of(const Damping &damping, const DampingModel model)
    {
      nlohmann::json result{{"model", option_name(model)}};
      if (damping.n_branches() > 0)
        {
          result["moduli hold at [Hz]"]       = damping.reference_frequency();
          result["moduli at rest over given"] = damping.modulus(0.);
        }
      return result;
    }


    // Waves below the band are hardly damped, and those in it the mesh has not.
    void
    check_band(const Model &model, Log &log)
    {
      const DampingParameters &damping = model.parameters.damping;
      if (damping.model == DampingModel::none || damping.ratio == 0. ||
          !damping.modes.empty())
        return;
      const double carried = model.carried_frequency();
      if (damping.lowest_frequency > carried)
        log.warn("\"Lowest frequency\" in section \"Damping\" is ",
                 damping.lowest_frequency,
                 " Hz, but the cells carry waves up to ",
                 carried,
                 " Hz only; give the natural frequencies that matter");
    }


    std::optional<double>
    kept_step(const ResultFolder &folder)
    {
      if (!folder.restarts())
        return {};
      return folder.checkpoint().at("time step").get<double>();
    }


    /** The shortest of all records [s]; 0 if nothing is recorded. */
    double
    record_interval(const NamedObjects<Observer>::List &observers)
    {
      double shortest = 0.;
      for (const auto &observer : observers)
        {
          const double interval = observer.second->record_interval();
          if (interval > 0. && (shortest == 0. || interval < shortest))
            shortest = interval;
        }
      return shortest;
    }


    std::unique_ptr<WaterMotion>
    make_water(const Model      &model,
               const Earthquake &earthquake,
               const TimeStep   &time_step)
    {
      if (!model.reservoir)
        return nullptr;
      return std::make_unique<WaterMotion>(*model.reservoir,
                                           earthquake.base,
                                           time_step.length);
    }


    // The worst cells of each material.
    nlohmann::json
    quality_summary(const Model &model, const MPI_Comm communicator)
    {
      const std::vector<std::string> names = model.parameters.material_names();
      std::vector<MeshQuality>       qualities(names.size());
      for (const auto &cell :
           model.grid.triangulation().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            std::array<Point<3>, 8> vertices;
            for (const unsigned int v : cell->vertex_indices())
              vertices[v] = cell->vertex(v);
            qualities[model.solid.grid().material(cell)].take(vertices);
          }
      nlohmann::json result;
      for (unsigned int i = 0; i < names.size(); ++i)
        result[names[i]] = {
          {"smallest scaled Jacobian",
           Utilities::MPI::min(qualities[i].scaled_jacobian, communicator)},
          {"largest aspect ratio",
           Utilities::MPI::max(qualities[i].aspect_ratio, communicator)},
          {"smallest angle [degrees]",
           Utilities::MPI::min(qualities[i].smallest_angle, communicator)}};
      return result;
    }
  } // namespace


  RunSetup::RunSetup(const Model        &model,
                     const Modes        &modes,
                     const ResultFolder &folder,
                     Log                &log)
    : model(model)
    , constraints(made_constraints(model))
    , observers(model.parameters.observers.make(model.parameters.file))
    , internal_force(internal_force_under(damping_by(model, modes), model))
    , undamped_limit(
        undamped_limit_of(model, internal_force, damping_by(model, modes)))
    , damping(damping_by(model,
                         modes,
                         internal_force.has_memory() ? undamped_limit : 0.))
    , time_step(model,
                internal_force,
                damping,
                undamped_limit,
                kept_step(folder),
                folder.wanted() ? record_interval(observers) : 0.,
                log)
    , earthquake(model, damping, time_step, log)
    , water(make_water(model, earthquake, time_step))
  {
    check_band(model, log);
    RestState unloaded(model);
    if (unloaded.contact) // refuses bars that are too stiff for the step
      unloaded.contact->prepare_step(
        [&](const unsigned int node) {
          return model.solid.mass.inverse.local_element(3 * node) *
                 Tensor<2, 3>(unit_symmetric_tensor<3>());
        },
        time_step.length);
    const ObservedModel seen = observed("",
                                        unloaded.initial,
                                        unloaded.initial.material_memory,
                                        model.contact.get(),
                                        log);
    for (const auto &observer : observers)
      observer.second->check(seen);
  }


  ObservedModel
  RunSetup::observed(const std::string       &folder,
                     const InitialState      &initial,
                     const MaterialMemory    &memory,
                     const Contact           *contact,
                     Log                     &log,
                     const CentralDifference *scheme) const
  {
    return {model.solid,
            internal_force,
            damping,
            memory,
            initial,
            water.get(),
            contact,
            folder,
            time_step.length,
            model.parameters.time.end_time,
            model.carried_frequency(),
            earthquake.base,
            ResultNames(model.parameters.material_names(), model.grid, contact),
            log,
            constraints,
            scheme};
  }


  nlohmann::json
  RunSetup::summary(const MPI_Comm communicator) const
  {
    Utilities::System::MemoryStats memory;
    Utilities::System::get_memory_stats(memory);
    const ResultNames names(model.parameters.material_names(),
                            model.grid,
                            model.contact.get());
    return {{"version", version()},
            {"title", model.parameters.title},
            {"SIMD bits", 64 * Lanes::size()},
            {"ranks", Utilities::MPI::n_mpi_processes(communicator)},
            {"cells", model.grid.triangulation().n_global_active_cells()},
            {"mesh quality", quality_summary(model, communicator)},
            {"unknowns", model.solid.discretization.dof_handler.n_dofs()},
            {"degree", model.solid.discretization.degree},
            {"time step [s]", time_step.length},
            {"largest stable step [s]", time_step.limit},
            {"damping", summary_of(damping, model.parameters.damping.model)},
            {"peak memory of a rank [MB]",
             Utilities::MPI::max(memory.VmHWM / 1024., communicator)},
            {"names", names.json()}};
  }
} // namespace Voussoir
