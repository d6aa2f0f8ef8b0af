#ifndef voussoir_loads_incoming_wave_h
#define voussoir_loads_incoming_wave_h

#include <voussoir/loads/absorbing_boundary.h>
#include <voussoir/loads/nodal_load.h>

namespace Voussoir
{
  /**
   * The earthquake that enters through the absorbing boundary: the nodal forces
   * A [ K u_ff + C v_ff + sigma_ff n ] of a free field.
   */
  class IncomingWave : public NodalLoad
  {
  public:
    IncomingWave(const AbsorbingBoundary     &boundary,
                 std::unique_ptr<FreeField> &&field);

    void
    add_forces(const double time, NodalForces &forces) override;

    /** See FreeField. */
    std::vector<double>
    save() const;

    void
    load(const std::vector<double> &numbers);

  private:
    const AbsorbingBoundary   &boundary;
    std::unique_ptr<FreeField> field;
  };
} // namespace Voussoir

#endif
