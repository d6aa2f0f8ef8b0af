#include <voussoir/analysis/static_cracks.h>

namespace Voussoir
{
  using namespace dealii;

  StaticCracks::StaticCracks(const Discretization &discretization,
                             const std::vector<const CellKernel *> &kernels,
                             const InternalForce &internal_force,
                             const Damping       &damping)
    : tips(discretization, kernels)
    , planes(discretization, kernels, internal_force, damping, true)
  {}


  bool
  StaticCracks::propagate(const Vector &displacement, MaterialMemory &memory)
  {
    constexpr double no_step = 1.; // [s], without velocity and damping
    State            now;
    now.displacement = displacement;
    now.velocity.reinit(displacement);
    now.material_memory    = std::move(memory);
    const bool have_tips   = tips.find(now.material_memory),
               have_planes = planes.find(no_step, now);
    memory                 = std::move(now.material_memory);
    return Utilities::MPI::logical_or(have_tips || have_planes,
                                      displacement.get_mpi_communicator());
  }
} // namespace Voussoir
