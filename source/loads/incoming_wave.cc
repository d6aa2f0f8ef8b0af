#include <voussoir/loads/incoming_wave.h>

namespace Voussoir
{
  IncomingWave::IncomingWave(const AbsorbingBoundary     &boundary,
                             std::unique_ptr<FreeField> &&field)
    : boundary(boundary)
    , field(std::move(field))
  {}


  void
  IncomingWave::add_forces(const double time, NodalForces &forces)
  {
    field->advance(time);
    boundary.add_forces(*field, forces);
  }


  void
  IncomingWave::replay(const double time)
  {
    field->replay(time);
  }
} // namespace Voussoir
