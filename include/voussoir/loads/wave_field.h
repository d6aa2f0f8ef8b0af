#ifndef voussoir_loads_wave_field_h
#define voussoir_loads_wave_field_h

#include <voussoir/fem/leap_frog.h>
#include <voussoir/loads/absorbing_boundary.h>
#include <voussoir/loads/ground_motion.h>

namespace Voussoir
{
  enum class WaveEntrance
  {
    absorbing_boundary,
    rigid_base
  };

  inline OptionNames<WaveEntrance>
  option_names(const WaveEntrance)
  {
    return {{WaveEntrance::absorbing_boundary, "absorbing boundary"},
            {WaveEntrance::rigid_base, "rigid base"}};
  }


  enum class WaveType
  {
    vertical,
    oblique_p,
    oblique_sv,
    oblique_sh
  };

  inline OptionNames<WaveType>
  option_names(const WaveType)
  {
    return {{WaveType::vertical, "vertical"},
            {WaveType::oblique_p, "oblique P"},
            {WaveType::oblique_sv, "oblique SV"},
            {WaveType::oblique_sh, "oblique SH"}};
  }


  /** The entries of the section "Wave field". */
  struct WaveParameters
  {
    WaveEntrance enters_through    = WaveEntrance::absorbing_boundary;
    WaveType     type              = WaveType::vertical;
    double       angle             = 15.;
    double       azimuth           = 0.;
    double       maximum_frequency = 25.;

    void
    declare(dealii::ParameterHandler &prm);
  };

  /** Refuses motions and models that do not suit a wave of this type. All
   *  ranks must call this together. */
  void
  check_wave(const AbsorbingBoundary   &boundary,
             const Solid               &solid,
             const WaveParameters      &wave,
             const MotionPlace          given_at,
             const GroundMotionSignals &motion);

  /** Entries of a wave field. */
  struct FreeFieldCase
  {
    const WaveParameters &wave;
    MotionPlace           given_at;
    QuadratureRule        quadrature; // of the cells and of a column
    double                duration;   // of the run [s]
  };

  /** The free field of a case, which check_wave() has accepted. */
  std::unique_ptr<FreeField>
  make_free_field(const AbsorbingBoundary &boundary,
                  const Solid             &solid,
                  const FreeFieldCase     &field,
                  GroundMotionSignals    &&motion,
                  const Damping           &damping,
                  const LeapFrog          &leap_frog);
} // namespace Voussoir

#endif
