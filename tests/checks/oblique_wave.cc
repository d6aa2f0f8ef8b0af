#include <voussoir/loads/oblique_wave.h>

#include "check.h"
#include "histories.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A plane wave that meets the surface at an angle, against the closed form
     * at points inside and at the surface. The closed form enters at the
     * boundary; the run shows that it satisfies the equations inside and at the
     * free surface.
     */
    class Oblique : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Points", points, "Where to compare.");
        prm.add_parameter("Tolerance", tolerance, "Error over peak.");
        prm.add_parameter("Surface factor",
                          surface_factor,
                          "Known displacement of the surface for a unit "
                          "incident one: in the horizontal direction of travel "
                          "(SH: across it), 0, and z.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto  parameters = make_case(file);
        const auto  simulation = make_simulation(*parameters, communicator);
        const auto  motion     = parameters->ground_motion.build(file.folder());
        const auto &field      = parameters->wave;
        const std::map<WaveType, ObliqueWave::Type> types{
          {WaveType::oblique_p, ObliqueWave::Type::P},
          {WaveType::oblique_sv, ObliqueWave::Type::SV},
          {WaveType::oblique_sh, ObliqueWave::Type::SH}};

        // the front reaches the first lower corner of the box at t = 0
        const auto &[lower, upper] = simulation->model.boundary.extent();
        const Point<3> origin(0.5 * (lower[0] + upper[0]),
                              0.5 * (lower[1] + upper[1]),
                              upper[2]);
        const auto     wave = [&](const double delay) {
          return ObliqueWave(
            types.at(field.type),
            field.angle * numbers::PI / 180.,
            field.azimuth * numbers::PI / 180.,
            simulation->model.solid.materials[0]->elastic_constants(),
            origin,
            delay);
        };
        double earliest = 0.;
        for (const double x : {lower[0], upper[0]})
          for (const double y : {lower[1], upper[1]})
            earliest =
              std::min(earliest, wave(0.).arrival(Point<3>(x, y, lower[2])));
        const ObliqueWave exact = wave(-earliest);

        const double       azimuth = field.azimuth * numbers::PI / 180.;
        const Tensor<1, 3> factor  = exact.surface_factor();
        const bool         across  = field.type == WaveType::oblique_sh;
        const double       along =
          across ?
                  factor[1] * std::cos(azimuth) - factor[0] * std::sin(azimuth) :
                  factor[0] * std::cos(azimuth) + factor[1] * std::sin(azimuth);
        verdicts.near("horizontal surface factor",
                      along,
                      surface_factor[0],
                      1e-5);
        if (!across)
          verdicts.near("vertical surface factor",
                        factor[2],
                        surface_factor[2],
                        1e-5);

        const auto places    = parse_points(points, "\"Points\"");
        const auto histories = run_and_record(*simulation, places);
        for (unsigned int p = 0; p < places.size(); ++p)
          {
            double error = 0., peak = 0.;
            for (std::size_t i = 0; i < histories.times.size(); ++i)
              {
                const Tensor<1, 3> expected =
                  exact.displacement(*motion[0],
                                     places[p].position,
                                     histories.times[i]);
                keep_largest(peak, expected.norm());
                keep_largest(error,
                             (histories.displacement[p][i] - expected).norm());
              }
            verdicts.below(places[p].name + ": error over peak",
                           error / peak,
                           tolerance);
          }
      }

    private:
      std::string  points;
      double       tolerance = 0.03;
      Tensor<1, 3> surface_factor;
    };

    // Reference: closed form
    const Registry<Check>::Add<Oblique>
      registered("oblique wave", "Oblique P, SV and SH in a half-space.");
  } // namespace
} // namespace Voussoir
