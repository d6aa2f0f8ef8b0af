#ifndef voussoir_loads_column_field_h
#define voussoir_loads_column_field_h

#include <voussoir/loads/ground_motion.h>
#include <voussoir/loads/wave_column.h>

namespace Voussoir
{
  /**
   * The layers of the side faces of a model, on its levels. Levels are left out
   * where the elements between them would not be stable at the time step (a
   * regular side mesh has no such levels).
   */
  std::vector<WaveColumn::Layer>
  layers_of_sides(const std::vector<SideFace>         &faces,
                  const std::vector<ElasticConstants> &constants,
                  const std::vector<double>           &damping_factors,
                  const unsigned int                   degree,
                  const double                         time_step,
                  const Damping                       &damping);

  /** The column as free field of a model. */
  class ColumnField : public FreeField
  {
  public:
    ColumnField(WaveColumn            &&column,
                GroundMotionSignals   &&incident,
                const BoundaryGeometry &geometry);

    void
    advance(const double time) override;

    std::vector<double>
    save() const override;

    void
    load(const std::vector<double> &numbers) override;

  private:
    WaveColumn          column;
    GroundMotionSignals incident;

    std::vector<unsigned int>              level_of_node;
    std::vector<WaveColumn::Interpolation> levels;
    std::vector<WaveColumn::StressPoint>   stress_points;
    struct Share
    {
      unsigned int         node, stress_point; // stress_point: invalid at base
      dealii::Tensor<1, 3> area;
    };
    std::vector<Share> shares;
  };

  /**
   * The wave that must enter at the base for the surface of the column to move
   * as @p surface does, by Fourier transform of the column's response to a
   * pulse. Frequencies above @p maximum_frequency [Hz] are removed. Responses
   * without end are computed up to the time @p longest [s]. Throws UserError if
   * the column's response does not die out.
   */
  GroundMotionSignals
  incident_for_surface(const WaveColumn          &column,
                       const GroundMotionSignals &surface,
                       const double               time_step,
                       const double               longest,
                       const double               maximum_frequency);
} // namespace Voussoir

#endif
