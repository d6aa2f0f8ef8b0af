#include <voussoir/driver/rest_state.h>
#include <voussoir/driver/run_setup.h>

namespace Voussoir
{
  namespace
  {
    Damping
    adapted_damping(DampingParameters parameters, const Modes &modes)
    {
      if (!parameters.modes.empty() && modes.list.empty())
        {
          parameters.model = "none";
          return Damping(parameters);
        }
      Damping damping(parameters);
      damping.adapt_to_modes(modes.frequencies());
      return damping;
    }


    // Waves below the band are hardly damped, and those in it the mesh has not.
    void
    check_band(const Model &model, Log &log)
    {
      const DampingParameters &damping = model.parameters.damping;
      if (damping.model == "none" || damping.ratio == 0. ||
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
    record_interval(const Model &model, const ResultFolder &folder)
    {
      double shortest = 0.;
      if (folder.wanted())
        for (const auto &observer : model.parameters.observers)
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
  } // namespace


  RunSetup::RunSetup(const Model        &model,
                     const Modes        &modes,
                     const ResultFolder &folder,
                     Log                &log)
    : model(model)
    , damping(adapted_damping(model.parameters.damping, modes))
    , time_step(model,
                damping,
                kept_step(folder),
                record_interval(model, folder),
                log)
    , earthquake(model, damping, time_step, log)
    , water(make_water(model, earthquake, time_step))
  {
    check_band(model, log);
    RestState unloaded(model);
    if (unloaded.contact) // refuses bars that are too stiff for the step
      unloaded.contact->prepare_step(
        [&](const unsigned int node) {
          return model.mass.inverse.local_element(3 * node) *
                 dealii::Tensor<2, 3>(dealii::unit_symmetric_tensor<3>());
        },
        time_step.length);
    const ObservedModel seen = observed("",
                                        unloaded.initial,
                                        unloaded.initial.material_memory,
                                        model.contact.get(),
                                        log);
    for (const auto &observer : model.parameters.observers)
      observer.second->check(seen);
  }


  ObservedModel
  RunSetup::observed(const std::string    &folder,
                     const InitialState   &initial,
                     const MaterialMemory &memory,
                     const Contact        *contact,
                     Log                  &log) const
  {
    return {model.discretization,
            model.materials,
            model.material_of_cell(),
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
            log};
  }
} // namespace Voussoir
