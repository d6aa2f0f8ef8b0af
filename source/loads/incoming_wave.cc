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


  std::vector<double>
  IncomingWave::save() const
  {
    return field->save();
  }


  void
  IncomingWave::load(const std::vector<double> &numbers)
  {
    field->load(numbers);
  }
} // namespace Voussoir
