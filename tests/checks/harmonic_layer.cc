#include <complex>

#include "check.h"
#include "histories.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A damped layer on elastic rock in a steady vertical S wave: its surface
     * amplifies the motion of an outcrop by
     *   1 / | cos(k* H) + i a* sin(k* H) | ,  k* = w sqrt(rho / G*) ,
     * with the ratio a* of the complex impedances, real in the rock below, and
     *   G* = G g(f) / Re g(f_0) ,
     * where g is that of the Maxwell branches,
     *   g = 1 + sum D_i i w t_i / (1 + i w t_i) ,
     * or of the given constant ratio (Kjartansson 1979),
     *   g = f^((4/pi) xi) (1 + 2 i xi) .
     */
    class HarmonicLayer : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Layer", layer, "Thickness of the soft layer [m].");
        prm.add_parameter("Frequencies", frequencies, "[Hz]");
        prm.add_parameter("Tolerance",
                          tolerance,
                          "Against the modulus of the branches.");
        prm.add_parameter("Tolerance of constant ratio",
                          of_constant,
                          "Against the given ratio.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const double f : frequencies)
          {
            // the last of the periods is steady: the initial wave has travelled
            // up and down the layer many times
            const double begin = 10. / f + 3., end = begin + 2. / f;
            const auto   parameters = make_case(
              file.with({"Ground motion/Sine/Frequency=" + std::to_string(f),
                           "Time/End time=" + std::to_string(end + 0.01)}));
            const auto simulation = make_simulation(*parameters, communicator);
            const auto motion =
              parameters->ground_motion.build(parameters->file.folder());
            const auto &[lower, upper] = simulation->model.boundary.extent();
            const ElasticConstants
              rock = simulation->model.solid.materials[0]->elastic_constants(),
              soil = simulation->model.solid.materials[1]->elastic_constants();
            const auto histories =
              run_and_record(*simulation, {{"surface", upper}});
            std::vector<double> outcrop;
            for (const double t : histories.times)
              outcrop.push_back(2. * motion[0]->displacement(t));
            const auto amplitude = [&](const std::vector<double> &values) {
              return oscillation(histories.times, values, f, begin, end);
            };
            const double ratio =
              amplitude(histories.component(0, 0)) / amplitude(outcrop);

            const double               xi      = parameters->damping.ratio;
            const Damping             &damping = simulation->run.damping;
            const double               f_0     = damping.reference_frequency();
            const std::complex<double> g_0     = of_branches(damping, f_0);
            std::ostringstream         name;
            name << "surface over outcrop at " << f << " Hz";
            verdicts.near(name.str(),
                          ratio,
                          amplification(rock,
                                        soil,
                                        f,
                                        of_branches(damping, f) / g_0.real()),
                          tolerance);
            verdicts.near(name.str() + ", constant ratio",
                          ratio,
                          amplification(rock,
                                        soil,
                                        f,
                                        std::pow(f / f_0,
                                                 4. / numbers::PI * xi) *
                                          std::complex<double>(1., 2. * xi)),
                          of_constant);
          }
      }

    private:
      double
      amplification(const ElasticConstants    &rock,
                    const ElasticConstants    &soil,
                    const double               f,
                    const std::complex<double> modulus) const
      {
        const std::complex<double> i(0., 1.),
          speed = soil.s_wave_speed() * std::sqrt(modulus),
          kH    = 2. * numbers::PI * f * layer / speed,
          a     = soil.density * speed / (rock.density * rock.s_wave_speed());
        return 1. / std::abs(std::cos(kH) + i * a * std::sin(kH));
      }

      static std::complex<double>
      of_branches(const Damping &damping, const double f)
      {
        std::complex<double> sum = 1.;
        for (unsigned int k = 0; k < damping.n_branches(); ++k)
          {
            const std::complex<double> x(0.,
                                         2. * numbers::PI * f *
                                           damping.relaxation_times[k]);
            sum += damping.coefficients[k] * x / (1. + x);
          }
        return sum;
      }

      /** Amplitude at a frequency of values that drift linearly, by least
       *  squares. */
      static double
      oscillation(const std::vector<double> &times,
                  const std::vector<double> &values,
                  const double               f,
                  const double               begin,
                  const double               end)
      {
        FullMatrix<double>     matrix(4, 4);
        dealii::Vector<double> rhs(4), x(4);
        for (std::size_t n = 0; n < times.size(); ++n)
          if (times[n] >= begin && times[n] <= end)
            {
              const double                w = 2. * numbers::PI * f * times[n];
              const std::array<double, 4> row{
                {std::sin(w), std::cos(w), 1., times[n] - begin}};
              for (unsigned int i = 0; i < 4; ++i)
                {
                  rhs(i) += row[i] * values[n];
                  for (unsigned int j = 0; j < 4; ++j)
                    matrix(i, j) += row[i] * row[j];
                }
            }
        matrix.gauss_jordan();
        matrix.vmult(x, rhs);
        return std::hypot(x(0), x(1));
      }

      double              layer = 10., tolerance = 0.01, of_constant = 0.05;
      std::vector<double> frequencies;
    };

    // Reference: closed form
    const Registry<Check>::Add<HarmonicLayer>
      registered("harmonic layer", "Damped amplification of a layer on rock.");
  } // namespace
} // namespace Voussoir
