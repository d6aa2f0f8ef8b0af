#include <voussoir/base/parse_numbers.h>

#include "check.h"
#include "histories.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Amplitudes at points over that of the incident wave, by the Fourier sums
     * of a pulse, against those of steady waves: each by itself or, where some
     * are small, over a common scale.
     */
    class SurfaceAmplitudes : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Points", points, "Where to compare.");
        prm.add_parameter("Frequencies", frequencies, "[Hz]");
        prm.add_parameter("Amplitudes",
                          amplitudes,
                          "Displacements per unit of the incident wave, at "
                          "the points; those of the frequencies separated by "
                          "\";\", for one component after the other.");
        prm.add_parameter("Components", components, "Of the displacements.");
        prm.add_parameter("Scale",
                          scale,
                          "Amplitude of which the tolerance is a share; 0: "
                          "that of each.");
        prm.add_parameter("Tolerance",
                          tolerance,
                          "Tolerance of each amplitude.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        const auto motion     = parameters->ground_motion.build(file.folder());
        const auto places     = parse_points(points, "\"Points\"");
        const auto histories  = run_and_record(*simulation, places);
        const auto rows       = split_list(amplitudes, ';');
        AssertThrow(rows.size() == frequencies.size() * components.size(),
                    ExcDimensionMismatch(rows.size(),
                                         frequencies.size() *
                                           components.size()));

        std::vector<double> incident;
        for (const double t : histories.times)
          incident.push_back(motion[0]->displacement(t));
        for (unsigned int i = 0; i < rows.size(); ++i)
          {
            const double       frequency = frequencies[i % frequencies.size()];
            const unsigned int d         = components[i / frequencies.size()];
            const auto         row       = split_list(rows[i]);
            AssertThrow(row.size() == places.size(),
                        ExcDimensionMismatch(row.size(), places.size()));
            const auto amplitude = [&](const std::vector<double> &values) {
              return std::abs(fourier_sum(histories.times,
                                          values,
                                          frequency,
                                          0.,
                                          parameters->time.end_time));
            };
            for (unsigned int p = 0; p < places.size(); ++p)
              {
                std::ostringstream name;
                name << frequency << " Hz at " << places[p].name;
                const double found = amplitude(histories.component(p, d)) /
                                     amplitude(incident),
                             wanted = parse_number(row[p]).value();
                if (scale == 0.)
                  verdicts.near(name.str(), found, wanted, tolerance);
                else
                  verdicts.below("xyz"[d] + (", " + name.str()) +
                                   ": off over the scale",
                                 (found - wanted) / scale,
                                 tolerance);
              }
          }
      }

    private:
      std::string               points, amplitudes;
      std::vector<double>       frequencies;
      std::vector<unsigned int> components{0};
      double                    tolerance = 0.03, scale = 0.;
    };

    // Reference: closed form
    const Registry<Check>::Add<SurfaceAmplitudes>
      registered("surface amplitudes", "Steady waves on ground of any shape.");
  } // namespace
} // namespace Voussoir
