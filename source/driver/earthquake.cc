#include <voussoir/driver/earthquake.h>

namespace Voussoir
{
  Earthquake::Earthquake(const Model    &model,
                         const Damping  &damping,
                         const TimeStep &time_step,
                         Log            &log)
  {
    const Case         &parameters    = model.parameters;
    const GroundMotion &ground_motion = parameters.ground_motion;
    if (ground_motion.type == "none")
      return;
    const double        end_time = parameters.time.end_time;
    GroundMotionSignals motion = ground_motion.build(parameters.file.folder());
    log(ground_motion.summary(motion, end_time));
    if (model.rigid_base())
      {
        base = RigidBase(std::move(motion));
        return;
      }
    if (ground_motion.given_at == "free surface")
      for (const auto &component : motion)
        if (component && std::isinf(component->end()))
          followed_to = end_time;
    auto field = make_free_field(model.boundary,
                                 model.discretization,
                                 model.materials,
                                 parameters.discretization.quadrature,
                                 damping,
                                 parameters.wave,
                                 ground_motion.given_at,
                                 std::move(motion),
                                 time_step.leap_frog(),
                                 end_time);
    if (field)
      wave = std::make_unique<IncomingWave>(model.boundary, std::move(field));
  }
} // namespace Voussoir
