#include <voussoir/base/error.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/loads/column_field.h>
#include <voussoir/loads/oblique_wave.h>
#include <voussoir/loads/wave_field.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  void
  WaveParameters::declare(ParameterHandler &prm)
  {
    add_option(
      prm,
      "Enters through",
      enters_through,
      "Absorbing boundary: as a wave, by forces on the boundary. Rigid base: "
      "as inertial forces on a model with fixed base; the motion computed is "
      "then relative to the base.");
    add_option(
      prm,
      "Type",
      type,
      "Vertical: x and y components travel upwards as S waves, z as a P wave, "
      "through the layers at the model's sides. Oblique waves travel in a "
      "homogeneous half-space; their motion is the single component that is "
      "given.");
    prm.add_parameter("Angle",
                      angle,
                      "Oblique waves: angle between the direction of travel "
                      "and the vertical [degrees]." +
                        usually(Usual::wave_angle),
                      Patterns::Double(0., 89.));
    prm.add_parameter("Azimuth",
                      azimuth,
                      "Oblique waves: horizontal direction of travel, from x "
                      "towards y [degrees].",
                      Patterns::Double(-360., 360.));
    prm.add_parameter(
      "Maximum frequency",
      maximum_frequency,
      "For motions given on level rock or at the free surface: higher "
      "frequencies are removed when the wave at the base is computed [Hz].",
      Patterns::Double(1.));
  }


  namespace
  {
    /** A signal times a constant. */
    class Scaled : public Signal
    {
    public:
      Scaled(std::unique_ptr<Signal> &&signal, const double factor)
        : signal(std::move(signal))
        , factor(factor)
      {}

      double
      displacement(const double time) const override
      {
        return factor * signal->displacement(time);
      }

      double
      velocity(const double time) const override
      {
        return factor * signal->velocity(time);
      }

      double
      acceleration(const double time) const override
      {
        return factor * signal->acceleration(time);
      }

      double
      end() const override
      {
        return signal->end();
      }

    private:
      std::unique_ptr<Signal> signal;
      const double            factor;
    };


    /** A column of the lowest rock up to the top, in elements no thinner than
     *  those of that rock, which are stable. */
    std::vector<WaveColumn::Layer>
    lowest_rock(const std::vector<WaveColumn::Layer> &layers)
    {
      const WaveColumn::Layer &lowest   = layers.front();
      double                   thinnest = lowest.upper - lowest.lower;
      for (const WaveColumn::Layer &layer : layers)
        if (layer.constants.p_wave_speed() == lowest.constants.p_wave_speed())
          thinnest = std::min(thinnest, layer.upper - layer.lower);
      const auto is_thin = [&](const WaveColumn::Layer &layer) {
        return layer.upper - layer.lower < (1. - 1e-9) * thinnest;
      };
      std::vector<WaveColumn::Layer> result;
      for (const WaveColumn::Layer &layer : layers)
        if (!result.empty() && is_thin(result.back()))
          result.back().upper = layer.upper;
        else
          result.push_back({layer.lower,
                            layer.upper,
                            lowest.constants,
                            lowest.damping_factor});
      if (result.size() > 1 && is_thin(result.back()))
        {
          const double top = result.back().upper;
          result.pop_back();
          result.back().upper = top;
        }
      return result;
    }


    /** Rock of an oblique wave, the same along the whole boundary. */
    ElasticConstants
    rock_at(const AbsorbingBoundary &boundary, const Solid &solid)
    {
      return solid.materials[boundary.materials_at_boundary()[0]]
        ->elastic_constants();
    }


    std::unique_ptr<FreeField>
    make_oblique_field(const AbsorbingBoundary &boundary,
                       const Discretization    &discretization,
                       const ElasticConstants  &rock,
                       const WaveParameters    &wave,
                       GroundMotionSignals    &&motion)
    {
      const auto type =
        wave.type == WaveType::oblique_p  ? ObliqueWave::Type::P :
        wave.type == WaveType::oblique_sv ? ObliqueWave::Type::SV :
                                            ObliqueWave::Type::SH;
      const double angle = wave.angle * numbers::PI / 180.;

      // the incident front touches the model's boundary at t = 0
      const auto       &box = boundary.extent();
      Point<3>          origin(0.5 * (box.first[0] + box.second[0]),
                      0.5 * (box.first[1] + box.second[1]),
                      box.second[2]);
      const double      azimuth = wave.azimuth * numbers::PI / 180.;
      const ObliqueWave undelayed(type, angle, azimuth, rock, origin, 0.);
      double            earliest = 0.;
      for (const Point<3> &node : boundary.geometry().nodes)
        earliest = std::min(earliest, undelayed.arrival(node));
      earliest =
        Utilities::MPI::min(earliest, discretization.grid.communicator());

      for (auto &component : motion)
        if (component)
          return std::make_unique<ObliqueField>(
            ObliqueWave(type, angle, azimuth, rock, origin, -earliest),
            std::move(component),
            boundary.geometry());
      return nullptr;
    }
  } // namespace


  void
  check_wave(const AbsorbingBoundary   &boundary,
             const Solid               &solid,
             const WaveParameters      &wave,
             const MotionPlace          given_at,
             const GroundMotionSignals &motion)
  {
    if (wave.type == WaveType::vertical)
      {
        if (boundary.side_faces().empty())
          throw UserError(
            "A vertical wave needs the levels of the model's sides, but the "
            "mesh has no vertical outer faces; let the model end at planes of "
            "constant x or y.");
        return;
      }
    if (boundary.materials_at_boundary().size() != 1)
      throw UserError("\"Type\" in section \"Wave field\" is an oblique wave, "
                      "which needs one material along the whole absorbing "
                      "boundary; use \"vertical\" for layered rock.");
    if (is_at_surface(given_at))
      throw UserError("\"Given at\" in section \"Ground motion\" cannot be \"" +
                      option_name(given_at) +
                      "\" with an oblique wave; give the "
                      "incident wave or the motion of an outcrop.");

    const auto n_given =
      std::count_if(motion.begin(), motion.end(), [](const auto &component) {
        return component != nullptr;
      });
    if (n_given > 1)
      throw UserError(
        "\"Type\" in section \"Wave field\" is an oblique wave, "
        "which has one motion, but section \"Ground motion\" "
        "gives " +
        std::to_string(n_given) +
        " components; keep one of them, which becomes that of the wave.");
    const ElasticConstants rock = rock_at(boundary, solid);
    const double           critical =
      std::asin(rock.s_wave_speed() / rock.p_wave_speed());
    if (wave.type == WaveType::oblique_sv &&
        wave.angle * numbers::PI / 180. >= critical)
      {
        std::ostringstream text;
        text << "\"Angle\" in section \"Wave field\" is " << wave.angle
             << " degrees, but an oblique SV wave must stay below the "
                "critical angle of this rock, "
             << std::setprecision(4) << critical * 180. / numbers::PI
             << " degrees; choose a smaller angle.";
        throw UserError(text.str());
      }
  }


  std::unique_ptr<FreeField>
  make_free_field(const AbsorbingBoundary &boundary,
                  const Solid             &solid,
                  const FreeFieldCase     &field,
                  GroundMotionSignals    &&motion,
                  const Damping           &damping,
                  const LeapFrog          &leap_frog)
  {
    // the incident wave at an outcrop is half the motion there
    if (field.given_at == MotionPlace::outcrop)
      for (auto &component : motion)
        if (component)
          component = std::make_unique<Scaled>(std::move(component), 0.5);

    const Discretization &discretization = solid.discretization;
    if (field.wave.type != WaveType::vertical)
      return make_oblique_field(boundary,
                                discretization,
                                rock_at(boundary, solid),
                                field.wave,
                                std::move(motion));

    std::vector<ElasticConstants> constants;
    std::vector<double>           factors;
    for (const Material *material : solid.materials)
      {
        constants.push_back(material->elastic_constants());
        factors.push_back(material->damping_factor());
      }
    const auto layers    = layers_of_sides(boundary.side_faces(),
                                        constants,
                                        factors,
                                        discretization.degree,
                                        leap_frog.time_step,
                                        damping);
    const auto column_of = [&](const std::vector<WaveColumn::Layer> &list) {
      return WaveColumn(
        list, discretization.degree, field.quadrature, damping, leap_frog);
    };
    WaveColumn column = column_of(layers);
    if (is_at_surface(field.given_at))
      motion = incident_for_surface(field.given_at == MotionPlace::level_rock ?
                                      column_of(lowest_rock(layers)) :
                                      column,
                                    motion,
                                    leap_frog.time_step,
                                    field.duration,
                                    field.wave.maximum_frequency);
    return std::make_unique<ColumnField>(std::move(column),
                                         std::move(motion),
                                         boundary.geometry());
  }
} // namespace Voussoir
