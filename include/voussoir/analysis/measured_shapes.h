#ifndef voussoir_analysis_measured_shapes_h
#define voussoir_analysis_measured_shapes_h

#include <voussoir/analysis/modal_model.h>
#include <voussoir/fem/point_weights.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  struct Mode;

  /** A mode shape that was measured: amplitudes at some points. */
  struct MeasuredShape
  {
    struct Amplitude
    {
      unsigned int point, direction;
      double       value;
    };

    std::string            name;
    std::vector<Amplitude> amplitudes;
  };

  /** The shapes of the entries, "first: crest y 1, quarter y 0.6; second: ...";
   *  refuses other text. */
  std::vector<MeasuredShape>
  measured_shapes(const ModeParameters &parameters);

  /** Part of the summary on the mode that is nearest to a shape. */
  nlohmann::json
  nearest_mode(const unsigned int number,
               const double       frequency,
               const double       criterion);

  /** Measured shapes and the modes that are nearest to them. */
  class MeasuredShapes
  {
  public:
    /** Refuses points outside the mesh. */
    MeasuredShapes(const ModalModel &model, const ModeParameters &parameters);

    /** For each shape the mode of the largest modal assurance criterion, (a .
     *  b)^2 / (a . a) (b . b), and its frequency. Called on all ranks. */
    nlohmann::json
    nearest(const std::vector<Mode> &modes) const;

  private:
    const std::vector<NamedPoint>    points;
    const std::vector<MeasuredShape> shapes;
    const PointWeights               weights;
  };
} // namespace Voussoir

#endif
