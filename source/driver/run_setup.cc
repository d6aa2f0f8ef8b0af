#include <voussoir/base/error.h>
#include <voussoir/driver/run_setup.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Damping of the case; none as long as the modes to which it is fitted are
     *  missing. */
    DampingParameters
    damping_known(const Model &model, const Modes &modes)
    {
      DampingParameters parameters = model.parameters.damping;
      if (!parameters.modes.empty() && modes.list.empty())
        parameters.model = DampingModel::none;
      return parameters;
    }


    std::vector<double>
    factors_on_stiffness(const Damping &damping, const Model &model)
    {
      std::vector<double> factors;
      for (const Material *material : model.solid.materials)
        factors.push_back(damping.stiffness_scale(material->damping_factor()));
      return factors;
    }


    // Warns of a damped band above the frequencies that the mesh carries: waves
    // below the band are hardly damped.
    void
    check_band(const Model &model, Log &log)
    {
      const DampingParameters &damping = model.parameters.damping;
      if (damping.model == DampingModel::none || damping.ratio == 0. ||
          !damping.modes.empty())
        return;
      const double carried = model.carried_frequency();
      if (damping.lowest_frequency > carried)
        log.warn(
          "\"Lowest frequency\" in section \"Damping\" is ",
          damping.lowest_frequency,
          " Hz, but the cells carry waves up to ",
          carried,
          " Hz only; give the band of the natural frequencies that matter");
    }


    std::optional<double>
    kept_step(const ResultFolder &folder)
    {
      if (!folder.restarts())
        return {};
      return folder.checkpoint().at("time step").get<double>();
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


    // Refuses bars across interfaces that are too stiff, as the stable step
    // does not include these springs.
    void
    refuse_stiff_bars(const Model &model, const double time_step)
    {
      if (!model.contact)
        return;
      Contact contact(*model.contact);
      contact.prepare_step(
        [&](const unsigned int node) {
          return model.solid.mass.inverse.local_element(3 * node) *
                 Tensor<2, 3>(unit_symmetric_tensor<3>());
        },
        time_step);
    }
  } // namespace


  RunSetup::DampedCells::DampedCells(const Model &model, const Modes &modes)
    : damping(damping_known(model, modes), modes.frequencies())
    , internal_force(
        model.solid.internal_force.with(factors_on_stiffness(damping, model)))
    , undamped_limit(0.)
  {
    if (!internal_force.has_memory() && damping.stiffening(1.) == 0.)
      return;
    undamped_limit = undamped_step(model, internal_force);
    if (internal_force.has_memory())
      damping.add_mesh_viscosity(undamped_limit);
  }


  RunSetup::RunSetup(RunPlan           &&plan,
                     const Modes        &modes,
                     const ResultFolder &folder,
                     Log                &log)
    : RunSetup(std::move(plan), DampedCells(plan.model, modes), folder, log)
  {}


  RunSetup::RunSetup(RunPlan           &&made,
                     DampedCells       &&cells,
                     const ResultFolder &folder,
                     Log                &log)
    : plan(std::move(made))
    , model(plan.model)
    , damping(std::move(cells.damping))
    , internal_force(std::move(cells.internal_force))
    , time_step(model,
                internal_force,
                damping,
                cells.undamped_limit,
                kept_step(folder),
                folder.wanted() ? plan.record_interval() : 0.,
                log)
    , earthquake(model, std::move(plan.motion.signals), damping, time_step)
    , water(make_water(model, earthquake, time_step))
  {
    check_band(model, log);
    refuse_stiff_bars(model, time_step.length);
  }


  void
  check_without_damping(const RunPlan      &plan,
                        const ResultFolder &folder,
                        Log                &log)
  {
    const Model      &model    = plan.model;
    DampingParameters without  = model.parameters.damping;
    without.model              = DampingModel::none;
    const InternalForce &force = model.solid.internal_force;
    TimeStep(model,
             force,
             Damping(without),
             undamped_step(model, force),
             kept_step(folder),
             folder.wanted() ? plan.record_interval() : 0.,
             log);
  }
} // namespace Voussoir
